// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "components/calibration/joint/calibration_frame.hpp"
#include "components/calibration/joint/condition.hpp"
#include "components/calibration/joint/depth_bias_prior.hpp"
#include "components/calibration/joint/unknown.hpp"
#include "libs/fem/load_state.hpp"
#include "libs/geometry/rigid_transform.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::calibration {

/// Everything that one joint calibration is about.
struct JointSetup {
  std::vector<CalibrationFrame> frames;
  std::vector<UnknownPtr> unknowns;
  std::vector<ConditionPtr> conditions;  ///< none beside an unknown scale
  std::vector<fem::StaticState> states;  ///< [frames] to start from; empty: from rest
  /// Models like the one that is calibrated (ModelsLike): each takes a share of the frames, on a
  /// thread of its own.
  std::vector<std::unique_ptr<robot::RobotModel>> helpers = {};
  geometry::RigidTransform T_robot_camera;  ///< to start from, or known
  bool fit_pose = true;
  std::optional<DepthBiasPrior> depth_bias;  ///< nothing: the depth is right
  /// [numbers that SurfaceSighting::shared speaks of] Whether each is the model's own: there again
  /// wherever the model is laid on the robot. They count in the errors of all that is estimated.
  std::vector<bool> shared_errors = {};
  /// How far a marker may lie from its place in the robot file, m, each axis (one sigma); 0: it
  /// lies there. Where it is not estimated it counts in the errors of all that is.
  double marker_offset_sigma_m = 0.0;
  bool estimate_marker_offsets = true;
};

}  // namespace palpate::calibration
