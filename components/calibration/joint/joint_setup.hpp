// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "components/calibration/joint/calibration_frame.hpp"
#include "components/calibration/joint/condition.hpp"
#include "components/calibration/joint/depth_bias_prior.hpp"
#include "components/calibration/joint/pose_prior.hpp"
#include "components/calibration/joint/unknown.hpp"
#include "libs/fem/load_state.hpp"
#include "libs/geometry/rigid_transform.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::calibration {

/// A depth camera beside the first, whose pose and depth bias are estimated.
struct FurtherCamera {
  std::string name;
  geometry::RigidTransform T_robot_camera;   ///< initial
  std::optional<PosePrior> pose_prior = {};  ///< nullopt: none
  std::optional<DepthBiasPrior> depth_bias = {};
};

/// Data, unknowns and known quantities of one joint calibration.
struct JointSetup {
  std::vector<CalibrationFrame> frames;
  std::vector<UnknownPtr> unknowns;
  std::vector<ConditionPtr> conditions;  ///< empty where the scale is an unknown
  std::vector<fem::StaticState> states;  ///< [frames] initial states; empty: undeformed
  /// Copies of the calibrated model (ModelsLike). Each takes a share of the frames on a thread of
  /// its own.
  std::vector<std::unique_ptr<robot::RobotModel>> helpers = {};
  geometry::RigidTransform T_robot_camera;  ///< of the first camera: initial, or known
  bool fit_pose = true;
  std::optional<PosePrior> pose_prior = {};  ///< of the pose that is fitted; nullopt: none
  /// Poses of other cameras, or of the frame that markers were measured in. They are estimated so
  /// that their errors count in the other parameters.
  std::vector<PosePrior> own_poses = {};
  std::optional<DepthBiasPrior> depth_bias;  ///< of the first camera; nullopt: none
  std::vector<FurtherCamera> further_cameras = {};
  /// [parameters of SurfaceSighting::shared] Whether each is an error of the model itself, which
  /// recurs wherever the model is aligned with the robot. All are considered in the covariance.
  std::vector<bool> shared_errors = {};
  /// Prior standard deviation of marker offsets, m, each axis; 0: none. Offsets that are not
  /// estimated are considered in the covariance.
  double marker_offset_sigma_m = 0.0;
  bool estimate_marker_offsets = true;
};

}  // namespace palpate::calibration
