// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "libs/geometry/box.hpp"
#include "libs/geometry/triangle_surface.hpp"

namespace palpate::geometry {

/// Where a surface comes nearest to a point.
struct SurfacePoint {
  int triangle = -1;
  Eigen::Vector3d barycentric = Eigen::Vector3d::Zero();  ///< of the triangle's corners, each >= 0
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  double distance_m = 0.0;  ///< >= 0
};

/// Barycentric coordinates of the point of triangle (a, b, c) nearest to `point_m`. Triangles
/// without area are fine. After Ericson, Real-Time Collision Detection (2005), 5.1.5.
Eigen::Vector3d ClosestPointOnTriangle(const Eigen::Vector3d& a_m, const Eigen::Vector3d& b_m,
                                       const Eigen::Vector3d& c_m, const Eigen::Vector3d& point_m);

/// Whether the ray from `origin_m` along `direction` (not zero) meets a triangle of the surface;
/// touching an edge counts. One pass over all triangles (Moeller and Trumbore 1997).
bool RayMeets(const TriangleSurface& surface, const Eigen::Vector3d& origin_m,
              const Eigen::Vector3d& direction);

/// Finds the nearest surface point in about log(t) steps: a tree of boxes over the triangles.
/// After a deformation, Refit() keeps the tree and updates its boxes in O(t), without allocation.
class SurfaceIndex {
 public:
  /// `surface` needs at least one triangle.
  explicit SurfaceIndex(TriangleSurface surface);

  const TriangleSurface& surface() const { return surface_; }

  /// Ties go to the triangle with the lowest number.
  SurfacePoint Closest(const Eigen::Vector3d& point_m) const;

  /// Triangles that come within `radius_m` of `point_m`, in rising order.
  std::vector<int> TrianglesWithin(const Eigen::Vector3d& point_m, double radius_m) const;

  /// New vertex positions [3 x v] of the same triangles.
  void Refit(const Eigen::Ref<const Eigen::Matrix3Xd>& vertices_m);

 private:
  /// Children follow their parent in nodes_; leaves hold a range of order_.
  struct Node {
    Box box;
    int left = -1;  ///< -1: a leaf
    int right = -1;
    int first = 0;
    int count = 0;
  };

  int Build(int first, int count, const Eigen::Matrix3Xd& centroids_m);
  void FitBox(Node* node) const;
  SurfacePoint ClosestInLeaf(const Node& leaf, const Eigen::Vector3d& point_m) const;

  TriangleSurface surface_;
  std::vector<Node> nodes_;
  std::vector<int> order_;
};

}  // namespace palpate::geometry
