// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <vector>

#include "components/offline/forces/estimate_plan.hpp"
#include "components/offline/images/image_opener.hpp"
#include "components/perception/config.hpp"
#include "libs/experiment/experiment.hpp"
#include "libs/geometry/pose_text.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::offline {

/// What the first image of each recording is compared with.
struct ImageCheck {
  const experiment::Experiment& experiment;
  robot::RobotModel* model = nullptr;
  robot::CableInput cable_input = robot::CableInput::kDisplacement;
  rgbd::DepthNoise noise;
  ImageOpener open;
  std::string pose_name;                   ///< of the experiment's camera pose, for messages
  geometry::PoseStandardError pose_error;  ///< of the camera's pose
};

/// Compares the first image of a contact-free recording, and of those of `plan` that are estimated
/// from their shape, with the robot at the camera pose. Throws RunError where one does not fit
/// (calibration::FindDepthMisfit), with the likely reasons. Recordings without a pose pass.
void RequireImagesFit(const ImageCheck& check, const std::vector<PlannedRecording>& plan);

}  // namespace palpate::offline
