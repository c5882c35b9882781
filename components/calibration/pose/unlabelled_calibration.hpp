// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <optional>
#include <string>
#include <vector>

#include "components/calibration/joint/joint_request.hpp"
#include "components/calibration/pose/frame_assignment.hpp"

namespace palpate::calibration {

struct UnlabelledSettings {
  JointRequest request;
  /// The points are labelled by `marker` (-1: none), and nothing is assigned.
  bool named = false;
  /// Standard deviation of the model's markers in the assignment, m: material, mesh, placement.
  double model_sigma_m = 1e-3;
  /// Choices whose ActuatorMisfit, with errors of `model_sigma_m`, exceeds the smallest by more
  /// than this are rejected.
  double most_actuator_misfit = 50.0;
  /// Assignments whose chi-squared, over the reduced one of the best, exceeds the best by no more
  /// than this are ambiguous.
  double ambiguous_below = 9.0;
  /// Camera pose of the last calibration. The camera may have moved since, so that this pose only
  /// decides between assignments that fit equally well.
  std::optional<geometry::RigidTransform> T_robot_camera_last = {};
};

struct UnlabelledCalibration {
  /// kUnobservable: the points determine no assignment, or no pose; otherwise as CalibrateFrames.
  Status status;
  JointCalibration joint;                ///< valid where `status` is ok
  FrameLabels labels;                    ///< accepted assignment
  std::vector<CalibrationFrame> frames;  ///< those of `labels`, labelled
  int choices = 0;                       ///< assignments that the frames alone leave
  bool decided_by_last_pose = false;     ///< between assignments that fit equally well
  std::vector<std::string> left_out;     ///< frames that are not used, and why
};

/// CalibrateFrames from unlabelled points. Where the frames alone are ambiguous (a symmetric
/// robot), choices that contradict the actuators (ActuatorMisfit) are rejected, and each remaining
/// one is calibrated. The best is accepted unless another fits equally well and the last pose does
/// not decide.
UnlabelledCalibration CalibrateUnlabelled(robot::RobotModel& model,
                                          const std::vector<UnlabelledFrame>& frames,
                                          const geometry::RigidTransform* T_rough,
                                          const UnlabelledSettings& settings);

}  // namespace palpate::calibration
