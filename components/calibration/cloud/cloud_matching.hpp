// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <vector>

#include "components/calibration/cloud/cloud_calibration.hpp"
#include "components/calibration/cloud/surface_in_view.hpp"

namespace palpate::calibration {

/// Whether these frames can be used, or why not.
Status CheckClouds(const robot::RobotModel& model, const std::vector<CloudFrame>& frames,
                   const CloudSettings& settings);

/// Points of a cloud matched to the visible surface, for the joint fit. `unbiased_m`: the points
/// without the depth bias estimated so far, camera frame. `match` gets all but the coverage.
std::vector<SurfaceSighting> MatchCloud(const SurfaceInView& surface, const ThinCloud& cloud,
                                        const Eigen::Matrix3Xd& unbiased_m,
                                        const geometry::RigidTransform& T_robot_camera,
                                        const CloudSettings& settings, CloudMatch* match);

}  // namespace palpate::calibration
