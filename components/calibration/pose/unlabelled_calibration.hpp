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
  /// The points' `marker` holds (-1: none); nothing is assigned.
  bool named = false;
  /// How far the model's markers may lie from the real ones when points are told apart, m, one
  /// sigma: of material, mesh, and where the markers sit.
  double model_sigma_m = 1e-3;
  /// Choices whose DriveMisfit, with errors of `model_sigma_m`, is larger than the least by more
  /// than this are not calibrated from.
  double most_drive_misfit = 50.0;
  /// Another assignment that fits the pictures no worse than by so much (chi-squared, over the
  /// reduced one of the best) fits as well.
  double ambiguous_below = 9.0;
  /// Where the camera stood when it was calibrated last. It may have been moved since: of what
  /// pictures and cables tell it takes nothing away, but of several assignments that fit alike that
  /// holds whose camera stands there.
  std::optional<geometry::RigidTransform> T_robot_camera_last = {};
};

struct UnlabelledCalibration {
  /// kUnobservable: the points do not tell which marker is which, or not the pose; else as
  /// CalibrateFrames.
  Status status;
  JointCalibration joint;                ///< usable where `status` is ok
  FrameLabels labels;                    ///< what it is from
  std::vector<CalibrationFrame> frames;  ///< likewise: those of `labels`, with their markers
  int choices = 0;                       ///< ways to tell the markers apart that pictures leave
  bool told_by_last_pose = false;        ///< which of several that fit alike
  std::vector<std::string> left_out;     ///< pictures that are in none of it, and why
};

/// CalibrateFrames from points without names. Where pictures alone do not tell which marker is
/// which (the robot looks the same after a turn) what is known of the cables may: choices whose
/// cables are pulled quite otherwise than the drives say (DriveMisfit) are given up, it is
/// calibrated with each of the others, and the one that explains all best holds, unless another
/// does as well and the last pose does not tell.
UnlabelledCalibration CalibrateUnlabelled(robot::RobotModel& model,
                                          const std::vector<UnlabelledFrame>& frames,
                                          const geometry::RigidTransform* T_rough,
                                          const UnlabelledSettings& settings);

}  // namespace palpate::calibration
