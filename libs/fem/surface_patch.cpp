// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/surface_patch.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "libs/core/check.hpp"
#include "libs/geometry/triangle_surface.hpp"

namespace palpate::fem {

namespace {

/// Edges of the pieces at the rim, as a part of the radius.
constexpr double kRimPiece = 1.0 / 16.0;
constexpr int kMaxDepth = 40;

/// Barycentric coordinates of the corners of a piece of a face, one column each.
using Piece = Eigen::Matrix3d;

/// Integrates the shape functions of one face over its part inside a ball.
class FaceIntegral {
 public:
  FaceIntegral(const Eigen::Matrix3d& corners_m, bool quadratic, const Eigen::Vector3d& centre_m,
               double radius_m)
      : corners_m_(corners_m),
        centre_m_(centre_m),
        radius_m_(radius_m),
        face_area_m2_(0.5 * (corners_m.col(1) - corners_m.col(0))
                                .cross(corners_m.col(2) - corners_m.col(0))
                                .norm()),
        shape_m2_(Eigen::VectorXd::Zero(quadratic ? 6 : 3)) {
    Add(Piece::Identity(), 0);
  }

  const Eigen::VectorXd& shape_m2() const { return shape_m2_; }
  double area_m2() const { return area_m2_; }

 private:
  double Outside_m(const Eigen::Vector3d& lambda) const {
    return (corners_m_ * lambda - centre_m_).norm() - radius_m_;
  }

  void Add(const Piece& piece, int depth) {
    const Eigen::Matrix3d points_m = corners_m_ * piece;
    const Eigen::Array3d outside_m =
        (points_m.colwise() - centre_m_).colwise().norm().array() - radius_m_;
    if ((outside_m <= 0.0).all()) return AddWhole(piece);
    const Eigen::Vector3d nearest = geometry::ClosestPointOnTriangle(
        points_m.col(0), points_m.col(1), points_m.col(2), centre_m_);
    if ((points_m * nearest - centre_m_).norm() >= radius_m_) return;
    const double longest_m = std::max({(points_m.col(1) - points_m.col(0)).norm(),
                                       (points_m.col(2) - points_m.col(1)).norm(),
                                       (points_m.col(0) - points_m.col(2)).norm()});
    if (longest_m <= kRimPiece * radius_m_ || depth == kMaxDepth) return AddCut(piece, outside_m);
    const Eigen::Vector3d mid_01 = 0.5 * (piece.col(0) + piece.col(1));
    const Eigen::Vector3d mid_12 = 0.5 * (piece.col(1) + piece.col(2));
    const Eigen::Vector3d mid_20 = 0.5 * (piece.col(2) + piece.col(0));
    Add((Piece() << piece.col(0), mid_01, mid_20).finished(), depth + 1);
    Add((Piece() << mid_01, piece.col(1), mid_12).finished(), depth + 1);
    Add((Piece() << mid_20, mid_12, piece.col(2)).finished(), depth + 1);
    Add((Piece() << mid_01, mid_12, mid_20).finished(), depth + 1);
  }

  /// The part of a small piece inside the ball, its arc replaced by the chord.
  void AddCut(const Piece& piece, const Eigen::Array3d& outside_m) {
    std::array<Eigen::Vector3d, 6> polygon;
    size_t size = 0;
    for (int k = 0; k < 3; ++k) {
      const int next = (k + 1) % 3;
      if (outside_m(k) <= 0.0) polygon[size++] = piece.col(k);
      if ((outside_m(k) <= 0.0) != (outside_m(next) <= 0.0)) {
        polygon[size++] = CrossingOf(piece.col(k), piece.col(next));
      }
    }
    for (size_t k = 2; k < size; ++k) {
      AddWhole((Piece() << polygon[0], polygon[k - 1], polygon[k]).finished());
    }
  }

  /// Where the edge between a point inside and a point outside meets the sphere.
  Eigen::Vector3d CrossingOf(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const {
    const Eigen::Vector3d start_m = corners_m_ * a - centre_m_;
    const Eigen::Vector3d edge_m = corners_m_ * (b - a);
    const double quadratic = edge_m.squaredNorm();
    const double half_linear = start_m.dot(edge_m);
    const double constant = start_m.squaredNorm() - radius_m_ * radius_m_;
    const double root = std::sqrt(std::max(0.0, half_linear * half_linear - quadratic * constant));
    const double leaving = (-half_linear + root) / quadratic;
    const double entering = (-half_linear - root) / quadratic;
    const double t = constant <= 0.0 ? leaving : entering;
    return a + std::clamp(t, 0.0, 1.0) * (b - a);
  }

  /// Mid-edge rule, exact for the quadratic shape functions.
  void AddWhole(const Piece& piece) {
    const double area_m2 = face_area_m2_ * std::abs(piece.determinant());
    area_m2_ += area_m2;
    for (int k = 0; k < 3; ++k) {
      AddShape(0.5 * (piece.col(k) + piece.col((k + 1) % 3)), area_m2 / 3.0);
    }
  }

  void AddShape(const Eigen::Vector3d& lambda, double area_m2) {
    if (shape_m2_.size() == 3) {
      shape_m2_ += area_m2 * lambda;
      return;
    }
    for (int k = 0; k < 3; ++k) {
      shape_m2_(k) += area_m2 * lambda(k) * (2.0 * lambda(k) - 1.0);
      shape_m2_(3 + k) += area_m2 * 4.0 * lambda(k) * lambda((k + 1) % 3);
    }
  }

  Eigen::Matrix3d corners_m_;
  Eigen::Vector3d centre_m_;
  double radius_m_;
  double face_area_m2_;
  Eigen::VectorXd shape_m2_;
  double area_m2_ = 0.0;
};

Eigen::Matrix3d FaceCorners_m(const geometry::TriangleSurface& surface, int face) {
  return (Eigen::Matrix3d() << surface.Corner(face, 0), surface.Corner(face, 1),
          surface.Corner(face, 2))
      .finished();
}

SurfacePatch PointPatch(const PointLocator& locator, const Eigen::Vector3d& point_m) {
  const BodyPoint point = locator.Embed(point_m);
  const geometry::SurfacePoint nearest = locator.surface().Closest(point_m);
  const Eigen::Vector3d normal =
      geometry::TriangleNormal(locator.surface().surface(), nearest.triangle);
  return {point.weights, point_m, normal, 0.0, point.distance_m};
}

}  // namespace

SurfacePatch MakeSurfacePatch(const PointLocator& locator, const Eigen::Vector3d& point_m,
                              double radius_m) {
  PALPATE_CHECK(radius_m >= 0.0, radius_m);
  if (radius_m == 0.0) return PointPatch(locator, point_m);

  const geometry::TriangleSurface& surface = locator.surface().surface();
  const BoundarySurface& boundary = locator.boundary();
  const bool quadratic = boundary.faces.rows() == 6;
  const geometry::SurfacePoint middle = locator.surface().Closest(point_m);
  std::vector<InterpolationWeights> parts;
  Eigen::Vector3d area_vector_m2 = Eigen::Vector3d::Zero();
  SurfacePatch patch;
  for (const int face : locator.surface().TrianglesWithin(middle.position_m, radius_m)) {
    const FaceIntegral integral(FaceCorners_m(surface, face), quadratic, middle.position_m,
                                radius_m);
    const auto nodes = boundary.faces.col(face);
    const Eigen::VectorXd& shape_m2 = integral.shape_m2();
    parts.push_back({{nodes.begin(), nodes.end()}, {shape_m2.begin(), shape_m2.end()}});
    patch.area_m2 += integral.area_m2();
    area_vector_m2 += integral.area_m2() * geometry::TriangleNormal(surface, face);
  }
  PALPATE_CHECK(patch.area_m2 > 0.0, radius_m);
  patch.weights = Combine(parts, std::vector<double>(parts.size(), 1.0 / patch.area_m2));
  for (size_t k = 0; k < patch.weights.nodes.size(); ++k) {
    patch.centre_m += patch.weights.weights[k] * locator.mesh().nodes_m.col(patch.weights.nodes[k]);
  }
  const bool faces_cancel = area_vector_m2.norm() < 1e-9 * patch.area_m2;
  patch.normal = faces_cancel ? geometry::TriangleNormal(surface, middle.triangle)
                              : Eigen::Vector3d(area_vector_m2.normalized());
  patch.distance_m = middle.distance_m;
  return patch;
}

}  // namespace palpate::fem
