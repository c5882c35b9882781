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

/// A point's part in an error that it has in common with others: of a number that is believed to be
/// 0 with a sigma of 1, how far the skin lies farther out along the normal per unit, m.
struct SharedError {
  int number = 0;  ///< into JointSetup::shared_errors
  double per_unit_m = 0.0;
};

/// A point of the depth image, and the place of the model's skin that it shows.
struct SurfaceSighting {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  ///< camera frame
  double sigma_m = 0.0;                                  ///< along the normal, > 0
  fem::InterpolationWeights point;                       ///< on the skin
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();     ///< unit, robot frame, of the skin there
  std::vector<SharedError> shared = {};                  ///< beside sigma_m, each number once
};

/// What was seen of the robot at rest under one setting of its cables, and what is known of that
/// setting. Measured values are where unknown inputs start from.
struct CalibrationFrame {
  std::string name;  ///< for messages
  std::vector<MarkerSighting> markers = {};
  std::vector<SurfaceSighting> surface = {};
  std::vector<robot::CableCommand> cables = {};  ///< one for each cable
  std::vector<robot::DeadLoad> loads = {};
  /// [loads] where the robot's size is an unknown; none: they hold on to the same part of the body
  /// whatever its size.
  std::vector<LoadPlace> load_places = {};
  Eigen::Vector3d gravity_m_s2 = Eigen::Vector3d::Zero();
};

}  // namespace palpate::calibration
