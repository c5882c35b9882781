// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <functional>

#include "libs/experiment/images/rgbd_sequence.hpp"

namespace palpate::offline {

/// experiment::OpenRecordingImages with a reader of settings files; what the images' notes say
/// reaches the user as the program wants. Throws InputError.
using ImageOpener = std::function<experiment::RgbdSequence(const experiment::Recording&)>;

}  // namespace palpate::offline
