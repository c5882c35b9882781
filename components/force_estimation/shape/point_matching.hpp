// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "components/force_estimation/shape/surface_matching.hpp"
#include "libs/rgbd/sensed_cloud.hpp"
#include "libs/skin/patch_matching.hpp"
#include "libs/skin/predicted_view.hpp"
#include "libs/skin/surface_features.hpp"

namespace palpate::force_estimation {

/// The way `point` of SurfaceMatching: Algorithm 3 as published, and hidden, too, what `view` does
/// not show. `x_m` [3n] robot frame.
void MatchPoints(const skin::SurfaceFeatures& features, const rgbd::SensedCloud& cloud,
                 const Eigen::Isometry3d& T_robot_camera, const Eigen::VectorXd& x_m,
                 const skin::PredictedView& view, const skin::MatchDistances& distances,
                 std::vector<skin::FeatureMatch>* matches);

}  // namespace palpate::force_estimation
