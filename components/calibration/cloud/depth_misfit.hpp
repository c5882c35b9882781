// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <vector>

#include "components/calibration/cloud/depth_agreement.hpp"
#include "components/calibration/misfit_reason.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::calibration {

/// Where the camera is said to be, and how nearly.
struct DepthMisfitRequest {
  std::string pose_name;  ///< for messages
  geometry::RigidTransform T_robot_camera;
  double translation_sigma_m = 0.0;  ///< of the camera's pose at the robot
  double rotation_sigma_rad = 0.0;
  /// Something may touch and bend the robot: only what no contact explains is a misfit. A pose that
  /// is merely off, size and stiffness are not.
  bool may_be_touched = false;
};

struct DepthMisfit {
  bool fits = false;
  MisfitReasons reasons;  ///< where the images do not fit
};

/// Compares whole depth images of one camera with the robot. Where they do not fit, tries mistakes
/// one at a time: another pose (off, inverted, of other axes, with another unit), another unit of
/// depth or of the mesh, another size, intrinsics of another resolution, another stiffness. A
/// mistake counts where mending it halves the misfit (DepthAgreement::Misfit). Lengths that the
/// search uses are shares of the robot's extent.
DepthMisfit FindDepthMisfit(const robot::RobotModel& model, const std::vector<DepthSight>& sights,
                            const DepthMisfitRequest& request);

}  // namespace palpate::calibration
