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

/// The frames of a camera beside the first, at the settings of `LiveJob::clouds` in which it saw
/// the robot.
struct FurtherCameraJob {
  std::string name;
  std::vector<CloudFrame> clouds;
  /// As of LiveJob.
  std::optional<geometry::DepthPicture> picture;
  geometry::RigidTransform T_robot_camera_start;
};

/// A calibration of frames of the running robot. One of `clouds`, `markers` and `points` is set.
struct LiveJob {
  JointRequest request;
  std::vector<CloudFrame> clouds;
  std::vector<FurtherCameraJob> further = {};  ///< beside the camera of `clouds`
  std::vector<CalibrationFrame> markers;       ///< with names
  std::vector<UnlabelledFrame> points;         ///< markers without names
  /// Size and lens of the clouds' depth images; nullopt: the depth bias is not estimated.
  std::optional<geometry::DepthPicture> picture;
  bool fit_depth_bias = true;  ///< as CloudSettings
  /// Initial pose: required for clouds, optional for markers. It decides the assignment of unnamed
  /// markers on a symmetric robot.
  std::optional<geometry::RigidTransform> T_robot_camera_start;
  /// Pose of the last calibration (UnlabelledSettings).
  std::optional<geometry::RigidTransform> T_robot_camera_last = {};
  /// The last calibration, which holds for parameters that are not estimated or not determined:
  /// moduli, Poisson's ratios, gravity, size (must be the model's), cable routes, actuators.
  std::optional<robot::CalibrationFile> before;
  std::string data;  ///< description of the data for the file
  std::int64_t found_ns_since_1970 = 0;
};

struct LiveResult {
  /// That of CalibrateFromClouds, CalibrateFrames or CalibrateUnlabelled.
  Status status;
  robot::CalibrationFile file;        ///< valid where `status` is ok
  std::vector<std::string> left_out;  ///< frames and further cameras that are not used, and why
  bool decided_by_last_pose = false;  ///< of UnlabelledCalibration
  /// Of the pose: rotation vector (rad), translation (m), robot frame.
  Eigen::Matrix<double, 6, 6> pose_covariance = Eigen::Matrix<double, 6, 6>::Zero();
};

/// Runs a job: the robot and the first camera, then each further camera against that robot, then
/// all that were found in one fit. A further camera whose fit fails keeps its pose of the last
/// calibration. Where the fit of all fails, which `left_out` says, those before it count. `model`
/// must be as the robot file has it and is left unchanged.
LiveResult CalibrateLive(robot::RobotModel& model, const LiveJob& job);

}  // namespace palpate::calibration
