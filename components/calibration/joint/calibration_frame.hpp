// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "components/calibration/load_place.hpp"
#include "components/calibration/marker_sighting.hpp"
#include "libs/fem/interpolation_weights.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::calibration {

/// Share of a point in an error that is common to several points: the surface lies farther out
/// along its normal by `per_unit_m` times a parameter with the prior N(0, 1).
struct SharedError {
  int number = 0;  ///< into JointSetup::shared_errors
  double per_unit_m = 0.0;
};

/// A point of a depth image, matched with a point of the model's surface.
struct SurfaceSighting {
  /// 0: that of the frame; k: JointSetup::further_cameras[k - 1].
  int camera = 0;
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  ///< frame of that camera
  double sigma_m = 0.0;                                  ///< along the normal, > 0
  fem::InterpolationWeights point;                       ///< on the surface
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();     ///< unit, robot frame, at that point
  std::vector<SharedError> shared = {};                  ///< beside sigma_m, each parameter once
};

/// Measurements of the robot at rest at one setting of its cables, and the known inputs. Measured
/// inputs are the initial values of unknown ones.
struct CalibrationFrame {
  std::string name;   ///< for messages
  int own_pose = -1;  ///< index into JointSetup::own_poses; -1: seen from the first camera
  std::vector<MarkerSighting> markers = {};
  bool by_depth_camera = true;  ///< the markers have the depth bias
  std::vector<SurfaceSighting> surface = {};
  std::vector<robot::ActuatorCommand> cables = {};  ///< one for each cable
  std::vector<robot::DeadLoad> loads = {};
  /// [loads] where the size is an unknown; empty: loads act on the same part of the body at every
  /// size.
  std::vector<LoadPlace> load_places = {};
  Eigen::Vector3d gravity_m_s2 = Eigen::Vector3d::Zero();
};

}  // namespace palpate::calibration
