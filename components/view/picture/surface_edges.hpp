// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "components/view/picture/camera.hpp"

namespace palpate::view {

/// Edges of a surface beyond its triangles.
struct SurfaceEdges {
  /// One unit normal for each corner of each triangle, the mean over the neighbours that it
  /// meets smoothly (below 35 degrees): round parts look round, creases stay sharp. [3 x 3m]
  Eigen::Matrix3Xd corner_normals;
  Eigen::Matrix2Xi all;       ///< [2 x k] every edge once
  Eigen::Matrix2Xi outlines;  ///< creases, borders and the contour against the background
};

/// Edges and normals of a triangulated surface as `camera` sees it. Triangles without area have a
/// zero normal and make no crease.
SurfaceEdges FindEdges(const Eigen::Matrix3Xd& points_m, const Eigen::Matrix3Xi& triangles,
                       const Camera& camera);

}  // namespace palpate::view
