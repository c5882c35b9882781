// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/robot/sensitivity/eyelet_gradient.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <array>
#include <cmath>
#include <numbers>

#include "libs/core/index.hpp"
#include "libs/fem/shape_functions.hpp"
#include "libs/geometry/closest_point.hpp"

namespace palpate::robot {

namespace {

/// Where an element's shape functions are expanded for a point, and how that place follows the
/// point.
struct Expansion {
  Eigen::Vector3d xi = Eigen::Vector3d::Zero();
  Eigen::Vector3d xi_along = Eigen::Vector3d::Zero();
};

/// Projection onto what the corners with a positive weight span: a corner, an edge or a face.
Eigen::Vector3d AlongFeature(const Eigen::Matrix3d& corners_m, const Eigen::Vector3d& barycentric,
                             const Eigen::Vector3d& direction) {
  Eigen::Index zeros = 0;
  Eigen::Index zero = 0;
  Eigen::Index positive = 0;
  for (Eigen::Index k = 0; k < 3; ++k) {
    if (barycentric[k] > 0.0) {
      positive = k;
    } else {
      zero = k;
      ++zeros;
    }
  }
  if (zeros == 2) return Eigen::Vector3d::Zero();
  if (zeros == 1) {
    const Eigen::Vector3d edge =
        (corners_m.col(positive) - corners_m.col(3 - zero - positive)).normalized();
    return edge.dot(direction) * edge;
  }
  const Eigen::Vector3d normal =
      (corners_m.col(1) - corners_m.col(0)).cross(corners_m.col(2) - corners_m.col(0)).normalized();
  return direction - normal.dot(direction) * normal;
}

/// Outside the mesh: the nearest point of the element's corner tetrahedron.
Expansion NearestInCell(const Eigen::Matrix<double, 3, 4>& corners_m,
                        const Eigen::Vector3d& point_m, const Eigen::Vector3d& direction) {
  constexpr std::array<std::array<int, 3>, 4> kFaces{{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
  const Eigen::Matrix3d edges_m = corners_m.rightCols<3>().colwise() - corners_m.col(0);
  const Eigen::Matrix3d to_reference = edges_m.inverse();
  Expansion nearest;
  double nearest_m = (corners_m.col(0) - point_m).norm();
  for (const auto& face : kFaces) {
    Eigen::Matrix3d face_m;
    for (int k = 0; k < 3; ++k) face_m.col(k) = corners_m.col(face[At(k)]);
    const Eigen::Vector3d barycentric =
        geometry::ClosestPointOnTriangle(face_m.col(0), face_m.col(1), face_m.col(2), point_m);
    const Eigen::Vector3d closest_m = face_m * barycentric;
    const double distance_m = (closest_m - point_m).norm();
    if (distance_m >= nearest_m) continue;
    nearest_m = distance_m;
    nearest.xi = to_reference * (closest_m - corners_m.col(0));
    nearest.xi_along = to_reference * AlongFeature(face_m, barycentric, direction);
  }
  return nearest;
}

/// Inside: the point's own reference coordinates, which do not matter to first order how they move.
Expansion WithinCell(const fem::TetMesh& mesh, const fem::BodyPoint& point) {
  Expansion expansion;
  constexpr std::array<std::array<int, 2>, 6> kEdges{
      {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}}};
  for (size_t k = 0; k < point.weights.nodes.size(); ++k) {
    const double weight = point.weights.weights[k];
    for (int a = 0; a < static_cast<int>(mesh.cells.rows()); ++a) {
      if (mesh.cells(a, point.cell) != point.weights.nodes[k]) continue;
      // Barycentric coordinates of the node: 1 at its corner, or 1/2 at both ends of its edge.
      if (a < 4) {
        if (a > 0) expansion.xi[a - 1] += weight;
      } else {
        for (const int corner : kEdges[At(a - 4)]) {
          if (corner > 0) expansion.xi[corner - 1] += 0.5 * weight;
        }
      }
    }
  }
  return expansion;
}

/// Derivative of PointLocator::Embed(point_m).weights along `direction`: with xi where the shape
/// functions N (gradients G, J = X G') are expanded and s = J^-1 (p - X N),
///   w = N + G' s,  dw = dG' s + G' J^-1 (dp - dJ s).
fem::InterpolationWeights PointWeightsAlong(const fem::PointLocator& locator,
                                            const Eigen::Vector3d& point_m,
                                            const Eigen::Vector3d& direction) {
  const fem::TetMesh& mesh = locator.mesh();
  const fem::BodyPoint point = locator.Embed(point_m);
  Eigen::Matrix3Xd X(3, mesh.cells.rows());
  for (Eigen::Index a = 0; a < X.cols(); ++a) {
    X.col(a) = mesh.nodes_m.col(mesh.cells(a, point.cell));
  }
  const Expansion at = point.distance_m > 0.0 ? NearestInCell(X.leftCols<4>(), point_m, direction)
                                              : WithinCell(mesh, point);
  const Eigen::Matrix3Xd G = fem::ShapeGradients(mesh.element_type(), at.xi);
  // The gradients are linear in xi.
  const Eigen::Matrix3Xd G_along =
      fem::ShapeGradients(mesh.element_type(), at.xi + at.xi_along) - G;
  const Eigen::Matrix3d inverse = (X * G.transpose()).inverse();
  const Eigen::Vector3d s =
      inverse * (point_m - X * fem::ShapeFunctions(mesh.element_type(), at.xi));
  const Eigen::VectorXd along =
      G_along.transpose() * s +
      G.transpose() * (inverse * (direction - X * (G_along.transpose() * s)));
  fem::InterpolationWeights weights;
  for (Eigen::Index a = 0; a < X.cols(); ++a) {
    weights.nodes.push_back(mesh.cells(a, point.cell));
    weights.weights.push_back(along[a]);
  }
  return weights;
}

}  // namespace

fem::InterpolationWeights EyeletWeightsAlong(const fem::PointLocator& locator,
                                             const Eigen::Vector3d& centre_m, double radius_m,
                                             const Eigen::Vector3d& direction) {
  if (radius_m == 0.0) {
    return fem::Combine({PointWeightsAlong(locator, centre_m, direction)}, {1.0});
  }
  // The rule of PointLocator::EmbedBall: the centre and the corners of an icosahedron.
  std::vector<fem::InterpolationWeights> parts{PointWeightsAlong(locator, centre_m, direction)};
  std::vector<double> factors{4.0 / 25.0};
  const double unit_m = radius_m * std::sqrt(5.0 / 7.0) / std::hypot(1.0, std::numbers::phi);
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign_1 : {-1.0, 1.0}) {
      for (const double sign_phi : {-1.0, 1.0}) {
        Eigen::Vector3d sample_m = centre_m;
        sample_m[axis] += sign_1 * unit_m;
        sample_m[(axis + 1) % 3] += sign_phi * unit_m * std::numbers::phi;
        parts.push_back(PointWeightsAlong(locator, sample_m, direction));
        factors.push_back(7.0 / 100.0);
      }
    }
  }
  return fem::Combine(parts, factors);
}

}  // namespace palpate::robot
