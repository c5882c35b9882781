// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "components/force_estimation/contact_site.hpp"
#include "components/force_estimation/pose_error.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::force_estimation {

/// Known shape of the body in a frame.
enum class ReferenceShape {
  kNone,         ///< unknown: forces are estimated
  kUndeformed,   ///< held in its undeformed shape
  kEquilibrium,  ///< contact-free, in static equilibrium under its weight and its cables
};

struct MarkerObservation {
  bool valid = false;
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  ///< robot frame
  Eigen::Vector3d sigma_m = Eigen::Vector3d::Zero();     ///< standard deviations along the robot's
                                                         ///< axes; 0: Config::marker_sigma_m
};

struct MarkerFrame {
  double t_s = 0.0;
  ReferenceShape reference = ReferenceShape::kNone;
  std::vector<MarkerObservation> markers;      ///< in the order of the robot's markers
  std::vector<robot::ActuatorCommand> cables;  ///< in the order of the robot's cables
  /// Where known loads act now. They are the contacts where the settings give none: of known place
  /// and unknown force.
  std::vector<ContactSite> loads = {};
  PoseError pose_error = {};  ///< of the map from what was measured to the robot frame
};

}  // namespace palpate::force_estimation
