// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "components/calibration/joint/calibration_frame.hpp"
#include "libs/robot/robot_body.hpp"

namespace palpate::calibration {

/// Standard deviations of the model's surface error. It is common to the points of a cloud, so that
/// a thousand of them determine the camera pose no better than it allows.
struct SurfaceErrorSettings {
  /// Along the normal, common to the whole surface: paint, light that enters silicone, shrinkage.
  double whole_sigma_m = 1e-4;
  /// Along the normal, per patch: facets, moulding, perception at edges.
  double patch_sigma_m = 1.5e-4;
  double patch_m = 0.02;  ///< > 0
  /// In each direction, smooth over a region: rest shape, sagging, eyelets that sink in.
  double region_sigma_m = 2e-4;
  double region_m = 0.05;  ///< > 0
  /// Share of the model's motion: common to body and frames, and per region and frame. The errors
  /// above are common to all frames.
  double motion_sigma = 0.02;
  double region_motion_sigma = 0.02;
};

/// Shares of surface points in these errors.
class SurfaceErrors {
 public:
  /// `rest_m` [3n]: nodes from which motion counts.
  SurfaceErrors(const robot::RobotBody& body, Eigen::VectorXd rest_m,
                const SurfaceErrorSettings& settings);

  /// Sets the SharedErrors of each surface sighting; `shapes_m` [frames]: nodes [3n] of the body.
  /// Returns JointSetup::shared_errors.
  std::vector<bool> Share(const std::vector<Eigen::VectorXd>& shapes_m,
                          std::vector<CalibrationFrame>* frames) const;

 private:
  SurfaceErrorSettings settings_;
  Eigen::VectorXd undeformed_m_;  ///< [3n]
  Eigen::VectorXd rest_m_;        ///< [3n]
  Eigen::Matrix3Xd patches_m_;    ///< [3 x patches] centres, undeformed body
  Eigen::Matrix3Xd regions_m_;    ///< [3 x regions] centres, undeformed body
};

}  // namespace palpate::calibration
