// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <vector>

#include "components/calibration/cloud/cloud_calibration.hpp"
#include "components/calibration/cloud/skin_in_view.hpp"

namespace palpate::calibration {

/// Why these frames cannot be used, or ok.
Status CheckClouds(const robot::RobotModel& model, const std::vector<CloudFrame>& frames,
                   const CloudSettings& settings);

/// Points of a cloud on the skin that is seen, ready for the joint fit; `unbiased_m`: where they
/// are held to be, camera frame, without the error of the depth that is known so far. `match` says
/// how many, but not what they cover.
std::vector<SurfaceSighting> MatchCloud(const SkinInView& skin, const ThinCloud& cloud,
                                        const Eigen::Matrix3Xd& unbiased_m,
                                        const geometry::RigidTransform& T_robot_camera,
                                        const CloudSettings& settings, CloudMatch* match);

}  // namespace palpate::calibration
