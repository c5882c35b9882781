// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "components/perception/color_config.hpp"

namespace palpate::perception {

/// Table and walls: (n, d) with n . p + d = 0 and |n| = 1 of at most three planes on which a good
/// share of the points [3 x n] lies over at least background_extent_m, found by RANSAC (PCL's;
/// the same points give the same planes).
std::vector<Eigen::Vector4f> FindLargePlanes(const Eigen::Matrix3Xf& points_m,
                                             const ColorConfig& config);

}  // namespace palpate::perception
