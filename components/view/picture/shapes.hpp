// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "components/view/picture/color.hpp"

namespace palpate::view {

/// Triangles with a normal at each corner, ready to be drawn.
struct ShadedTriangles {
  struct Corner {
    Eigen::Vector3d point_m;
    Eigen::Vector3d normal;
    Color color;
  };
  std::vector<Corner> corners;  ///< three for each triangle

  void AddTriangle(const Corner& a, const Corner& b, const Corner& c);
};

void AddBall(const Eigen::Vector3d& center_m, double radius_m, const Color& color,
             ShadedTriangles* out);

/// A frustum without end caps from a to b; a radius of 0 makes a cone.
void AddFrustum(const Eigen::Vector3d& a_m, double radius_a_m, const Eigen::Vector3d& b_m,
                double radius_b_m, const Color& color, ShadedTriangles* out);

/// A disc facing along `normal`.
void AddDisc(const Eigen::Vector3d& center_m, const Eigen::Vector3d& normal, double radius_m,
             const Color& color, ShadedTriangles* out);

/// A box; the columns of `half_axes_m` are its half edges.
void AddBox(const Eigen::Vector3d& center_m, const Eigen::Matrix3d& half_axes_m, const Color& color,
            ShadedTriangles* out);

}  // namespace palpate::view
