// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <vector>

#include "components/calibration/cloud/cloud_frame.hpp"
#include "components/offline/images/image_samples.hpp"
#include "components/palpate/images/robot_viewer.hpp"
#include "components/perception/config.hpp"
#include "libs/robot/robot_body.hpp"

namespace palpate::command {

/// Point clouds of the robot in these frames; `expected`: predicted nodes for each, or none. Frames
/// in which the robot is not found are excluded, with a line for each in `left_out`.
std::vector<calibration::CloudFrame> SeeClouds(const std::vector<offline::ImageSample>& samples,
                                               const perception::Config& config,
                                               const robot::RobotBody& body,
                                               const std::vector<ExpectedNodes>& expected,
                                               std::vector<std::string>* left_out);

}  // namespace palpate::command
