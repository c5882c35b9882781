// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace palpate::view {

/// Signed distance of the points near each node of a surface to its tangent plane, along the
/// outward normal: positive where the measured surface lies outside of the model's. Of each node
/// the nearest point within `radius_m` counts; NaN where there is none. m.
///
/// `positions_m` [3 n], `triangles` [3 m] seen anticlockwise from outside, `points_m` [3 x k], all
/// in one frame. Takes time and memory in proportion to n + m + k.
std::vector<float> SurfaceResidual(const std::vector<float>& positions_m,
                                   const std::vector<std::uint32_t>& triangles,
                                   const Eigen::Matrix3Xf& points_m, float radius_m);

}  // namespace palpate::view
