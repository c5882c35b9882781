// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "libs/experiment/images/rgbd_sequence.hpp"

namespace palpate::command {

/// experiment::OpenRecordingImages; what it assumes of the images is printed to stderr, once for
/// each recording. Throws InputError.
experiment::RgbdSequence OpenImages(const experiment::Recording& recording);

}  // namespace palpate::command
