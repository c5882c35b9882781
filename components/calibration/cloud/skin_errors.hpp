// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "components/calibration/joint/calibration_frame.hpp"
#include "libs/robot/robot_body.hpp"

namespace palpate::calibration {

/// How far the model's skin may lie off the robot's as a camera sees it, one sigma each. The points
/// of a cloud have that in common, so that a thousand of them tell the camera's pose no better than
/// it allows.
struct SkinErrorSettings {
  /// Along the normal, all of it alike: paint, light that enters the silicone, shrinkage.
  double whole_sigma_m = 1e-4;
  /// Along the normal, of each patch on its own: facets, moulding, what perception makes of edges.
  double patch_sigma_m = 1.5e-4;
  double patch_m = 0.02;  ///< > 0
  /// In each direction, smoothly over so long a part of the body: its shape at rest, how it sags,
  /// how deep its cables' eyelets sink in.
  double region_sigma_m = 2e-4;
  double region_m = 0.05;  ///< > 0
  /// By more or less than the model moves, as a share: all of the body in all settings of the
  /// cables, and each region in each setting. The errors above are alike in all.
  double motion_sigma = 0.02;
  double region_motion_sigma = 0.02;
};

/// Tells for each point of the skin which errors it has a part in.
class SkinErrors {
 public:
  /// `rest_m` [3n]: nodes from where motion counts.
  SkinErrors(const robot::RobotBody& body, Eigen::VectorXd rest_m,
             const SkinErrorSettings& settings);

  /// Gives each sighting of the skin its SharedErrors; `shapes_m` [frames]: nodes [3n] of the body
  /// in each. Returns JointSetup::shared_errors.
  std::vector<bool> Share(const std::vector<Eigen::VectorXd>& shapes_m,
                          std::vector<CalibrationFrame>* frames) const;

 private:
  SkinErrorSettings settings_;
  Eigen::VectorXd undeformed_m_;  ///< [3n]
  Eigen::VectorXd rest_m_;        ///< [3n]
  Eigen::Matrix3Xd patches_m_;    ///< [3 x patches] middles, undeformed body
  Eigen::Matrix3Xd regions_m_;    ///< [3 x regions] middles, undeformed body
};

}  // namespace palpate::calibration
