// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "libs/robot/robot_model.hpp"

namespace palpate::force_estimation {

/// What is known of the body's shape while a frame was taken.
enum class ReferenceShape {
  kNone,         ///< nothing: forces are estimated
  kUndeformed,   ///< held in its undeformed shape
  kEquilibrium,  ///< at rest under its own weight and its cables, nobody touches it
};

struct MarkerObservation {
  bool valid = false;
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  ///< robot frame
  Eigen::Vector3d sigma_m = Eigen::Vector3d::Zero();     ///< one sigma; 0: Config's
};

struct MarkerFrame {
  double t_s = 0.0;
  ReferenceShape reference = ReferenceShape::kNone;
  std::vector<MarkerObservation> markers;   ///< in the order of the robot's markers
  std::vector<robot::CableCommand> cables;  ///< in the order of the robot's cables
};

}  // namespace palpate::force_estimation
