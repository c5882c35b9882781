// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "components/calibration/cloud/cloud_frame.hpp"
#include "components/calibration/joint/joint_request.hpp"
#include "components/calibration/pose/frame_assignment.hpp"
#include "libs/core/status.hpp"
#include "libs/robot/calibration_file.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::calibration {

/// A calibration of frames that were taken from the running robot.
struct LiveJob {
  JointRequest request;
  std::vector<CloudFrame> clouds;         ///< these,
  std::vector<CalibrationFrame> markers;  ///< or these,
  std::vector<UnlabelledFrame> points;    ///< or these, of markers without names
  /// That the clouds were made from: without, their depth bias is not looked for.
  std::optional<geometry::DepthPicture> picture;
  bool fit_depth_bias = true;  ///< of CloudSettings
  /// Where the search for the pose starts; clouds need it, markers tell it. Those without names
  /// on a robot that looks the same after a turn are told apart by it.
  std::optional<geometry::RigidTransform> T_robot_camera_start;
  /// Where it stood when it was calibrated last (UnlabelledSettings).
  std::optional<geometry::RigidTransform> T_robot_camera_last = {};
  /// What holds where nothing else is looked for or determined: moduli, Poisson's ratios, gravity,
  /// the robot's size, which must be the model's, its guides, and how drives are read.
  std::optional<robot::CalibrationFile> before;
  std::string data;  ///< what it is fitted to, for people
  std::int64_t found_ns_since_1970 = 0;
};

struct LiveResult {
  /// Why not, as of CalibrateFromClouds, CalibrateFrames and CalibrateUnlabelled.
  Status status;
  robot::CalibrationFile file;        ///< where it is ok
  std::vector<std::string> left_out;  ///< frames that are in none of it, and why
  bool told_by_last_pose = false;     ///< of UnlabelledCalibration
  /// Of the pose: rotation vector (rad), translation (m), robot frame.
  Eigen::Matrix<double, 6, 6> pose_covariance = Eigen::Matrix<double, 6, 6>::Zero();
};

/// Runs it. `model`, which must be as the robot file has it, is left so.
LiveResult CalibrateLive(robot::RobotModel& model, const LiveJob& job);

}  // namespace palpate::calibration
