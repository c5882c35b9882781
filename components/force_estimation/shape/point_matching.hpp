// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <span>

#include "components/force_estimation/shape/surface_matching.hpp"
#include "libs/correspondence/patch_matching.hpp"
#include "libs/correspondence/predicted_view.hpp"
#include "libs/correspondence/surface_features.hpp"
#include "libs/rgbd/sensed_cloud.hpp"

namespace palpate::force_estimation {

/// Method `point` of SurfaceMatching: Algorithm 3 as published; what `view` does not show is
/// hidden, too. `x_m` [3n] robot frame. `matches`: [features].
void MatchPoints(const correspondence::SurfaceFeatures& features, const rgbd::SensedCloud& cloud,
                 const Eigen::Isometry3d& T_robot_camera, const Eigen::VectorXd& x_m,
                 const correspondence::PredictedView& view,
                 const correspondence::MatchDistances& distances,
                 std::span<correspondence::FeatureMatch> matches,
                 const SurfaceMatchingTuning& tuning);

}  // namespace palpate::force_estimation
