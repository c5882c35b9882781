// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <vector>

#include "components/calibration/cloud/cloud_frame.hpp"

namespace palpate::calibration {

/// Frames of all cameras, one for each setting: those of one name are of one setting. `further`
/// [further cameras]: frames of each, its clouds as CloudFrame::cloud. Of a setting that several
/// cameras see, the inputs are those of the first of them.
std::vector<CloudFrame> JoinFrames(std::vector<CloudFrame> first,
                                   const std::vector<std::vector<CloudFrame>>& further);

}  // namespace palpate::calibration
