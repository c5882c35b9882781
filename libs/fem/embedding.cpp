// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/embedding.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "libs/core/check.hpp"
#include "libs/core/index.hpp"
#include "libs/fem/shape_functions.hpp"

namespace palpate::fem {

namespace {

/// A barycentric coordinate down to this still counts as inside: rounding of points on a face.
constexpr double kInside = -1e-9;
/// Corrections for the curvature of a tet10 read from a file; straight edges need none.
constexpr int kMaxCurvatureSteps = 20;
constexpr double kCurvatureTolerance = 1e-13;

Eigen::Matrix3Xd CellNodes_m(const TetMesh& mesh, int cell) {
  Eigen::Matrix3Xd nodes_m(3, mesh.cells.rows());
  for (Eigen::Index k = 0; k < mesh.cells.rows(); ++k) {
    nodes_m.col(k) = mesh.nodes_m.col(mesh.cells(k, cell));
  }
  return nodes_m;
}

/// Centre and corners of an icosahedron, scaled for a ball of radius 1, and their weights.
struct BallRule {
  std::array<Eigen::Vector3d, 13> points;
  std::array<double, 13> weights;
};

BallRule MakeBallRule() {
  BallRule rule;
  rule.points[0].setZero();
  rule.weights[0] = 4.0 / 25.0;
  const double unit = std::sqrt(5.0 / 7.0) / std::hypot(1.0, std::numbers::phi);
  size_t point = 1;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign_1 : {-1.0, 1.0}) {
      for (const double sign_phi : {-1.0, 1.0}) {
        rule.points[point].setZero();
        rule.points[point](axis) = sign_1 * unit;
        rule.points[point]((axis + 1) % 3) = sign_phi * unit * std::numbers::phi;
        rule.weights[point] = 7.0 / 100.0;
        ++point;
      }
    }
  }
  return rule;
}

}  // namespace

InterpolationWeights Combine(const std::vector<InterpolationWeights>& parts,
                             const std::vector<double>& factors) {
  PALPATE_CHECK(parts.size() == factors.size(), parts.size(), factors.size());
  std::map<int, double> sums;
  for (size_t p = 0; p < parts.size(); ++p) {
    for (size_t k = 0; k < parts[p].nodes.size(); ++k) {
      sums[parts[p].nodes[k]] += factors[p] * parts[p].weights[k];
    }
  }
  InterpolationWeights combined;
  for (const auto& [node, weight] : sums) {
    combined.nodes.push_back(node);
    combined.weights.push_back(weight);
  }
  return combined;
}

PointLocator::PointLocator(const TetMesh& mesh)
    : mesh_(mesh), boundary_(ExtractBoundary(mesh)), surface_(RestSurface(mesh, boundary_)) {
  const int count = mesh.CellCount();
  centroids_m_.resize(3, count);
  to_reference_.reserve(static_cast<size_t>(count));
  for (int cell = 0; cell < count; ++cell) {
    const Eigen::Matrix<double, 3, 4> corners_m = CellNodes_m(mesh_, cell).leftCols<4>();
    const Eigen::Matrix3d edges_m = corners_m.rightCols<3>().colwise() - corners_m.col(0);
    PALPATE_CHECK(edges_m.determinant() > 0.0, cell);
    centroids_m_.col(cell) = corners_m.rowwise().mean();
    to_reference_.push_back(edges_m.inverse());
  }
  BuildGrid();
}

void PointLocator::BuildGrid() {
  const geometry::Box box = geometry::BoundingBox(centroids_m_);
  const double cells_per_axis = std::cbrt(static_cast<double>(mesh_.CellCount()));
  grid_size_.setConstant(std::clamp(static_cast<int>(cells_per_axis), 1, 64));
  grid_origin_m_ = box.lower_m;
  const double tiny_m = 1e-6 * box.Diagonal_m() + 1e-12;
  grid_step_m_ = ((box.upper_m - box.lower_m).array() + tiny_m) / grid_size_.cast<double>();
  grid_.assign(static_cast<size_t>(grid_size_.prod()), {});
  for (int cell = 0; cell < mesh_.CellCount(); ++cell) {
    const geometry::Box cell_box = geometry::BoundingBox(CellNodes_m(mesh_, cell));
    const Eigen::Array3i first = GridIndex(cell_box.lower_m.array() - tiny_m);
    const Eigen::Array3i last = GridIndex(cell_box.upper_m.array() + tiny_m);
    for (int x = first.x(); x <= last.x(); ++x) {
      for (int y = first.y(); y <= last.y(); ++y) {
        for (int z = first.z(); z <= last.z(); ++z) grid_[GridCell({x, y, z})].push_back(cell);
      }
    }
  }
}

/// Points beyond the grid belong to its outermost cells.
Eigen::Array3i PointLocator::GridIndex(const Eigen::Vector3d& point_m) const {
  const Eigen::Array3d steps = (point_m - grid_origin_m_).array() / grid_step_m_.array();
  const Eigen::Array3d last = (grid_size_ - 1).cast<double>();
  return steps.floor().max(0.0).min(last).cast<int>();
}

size_t PointLocator::GridCell(const Eigen::Array3i& index) const {
  return static_cast<size_t>((index.z() * grid_size_.y() + index.y()) * grid_size_.x() + index.x());
}

Eigen::Vector4d PointLocator::Barycentric(int cell, const Eigen::Vector3d& point_m) const {
  const Eigen::Vector3d xi =
      to_reference_[At(cell)] * (point_m - mesh_.nodes_m.col(mesh_.cells(0, cell)));
  return {1.0 - xi.sum(), xi.x(), xi.y(), xi.z()};
}

int PointLocator::HoldingCell(const Eigen::Vector3d& point_m) const {
  int holder = -1;
  double deepest = kInside;
  for (const int cell : grid_[GridCell(GridIndex(point_m))]) {
    const double depth = Barycentric(cell, point_m).minCoeff();
    if (depth > deepest) {
      deepest = depth;
      holder = cell;
    }
  }
  return holder;
}

int PointLocator::NearestCentroid(const Eigen::Vector3d& point_m) const {
  Eigen::Index nearest = 0;
  (centroids_m_.colwise() - point_m).colwise().squaredNorm().minCoeff(&nearest);
  return static_cast<int>(nearest);
}

/// The point of the cell's corner tetrahedron nearest to a point outside of it.
Eigen::Vector3d PointLocator::ClosestReferencePoint(int cell,
                                                    const Eigen::Vector3d& point_m) const {
  constexpr std::array<std::array<int, 3>, 4> kFaces{{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
  const Eigen::Matrix<double, 3, 4> corners_m = CellNodes_m(mesh_, cell).leftCols<4>();
  Eigen::Vector4d nearest = Eigen::Vector4d::UnitX();
  double nearest_m = (corners_m.col(0) - point_m).norm();
  for (const auto& face : kFaces) {
    const Eigen::Vector3d weights = geometry::ClosestPointOnTriangle(
        corners_m.col(face[0]), corners_m.col(face[1]), corners_m.col(face[2]), point_m);
    Eigen::Vector4d lambda = Eigen::Vector4d::Zero();
    for (int k = 0; k < 3; ++k) lambda(face[At(k)]) = weights(k);
    const double distance_m = (corners_m * lambda - point_m).norm();
    if (distance_m < nearest_m) {
      nearest_m = distance_m;
      nearest = lambda;
    }
  }
  return nearest.tail<3>();
}

/// Shape functions at `xi` plus their first-order change on the way from there to `point_m`.
Eigen::VectorXd PointLocator::ExpandAbout(int cell, const Eigen::Vector3d& xi,
                                          const Eigen::Vector3d& point_m) const {
  const Eigen::Matrix3Xd nodes_m = CellNodes_m(mesh_, cell);
  const Eigen::VectorXd shape = ShapeFunctions(mesh_.element_type(), xi);
  const Eigen::Matrix3Xd gradients = ShapeGradients(mesh_.element_type(), xi);
  const Eigen::Matrix3d jacobian_m = nodes_m * gradients.transpose();
  const Eigen::Vector3d step = jacobian_m.inverse() * (point_m - nodes_m * shape);
  return shape + gradients.transpose() * step;
}

Eigen::Vector3d PointLocator::Locate(const Eigen::Vector3d& point_m, int* cell) const {
  const int holder = HoldingCell(point_m);
  *cell = holder >= 0 ? holder : NearestCentroid(point_m);
  if (holder < 0) return ClosestReferencePoint(*cell, point_m);
  const Eigen::Matrix3Xd nodes_m = CellNodes_m(mesh_, *cell);
  const double size_m = (nodes_m.leftCols<4>().colwise() - nodes_m.col(0)).norm();
  Eigen::Vector3d xi = Barycentric(holder, point_m).tail<3>();
  for (int step = 0; step < kMaxCurvatureSteps; ++step) {
    const Eigen::Vector3d gap_m = point_m - nodes_m * ShapeFunctions(mesh_.element_type(), xi);
    if (gap_m.norm() < kCurvatureTolerance * size_m) break;
    const Eigen::Matrix3d jacobian_m =
        nodes_m * ShapeGradients(mesh_.element_type(), xi).transpose();
    xi += jacobian_m.inverse() * gap_m;
  }
  return xi;
}

InterpolationWeights PointLocator::Weights(const Eigen::Vector3d& point_m, int* cell) const {
  const Eigen::Vector3d xi = Locate(point_m, cell);
  const Eigen::VectorXd values = ExpandAbout(*cell, xi, point_m);
  InterpolationWeights weights;
  for (Eigen::Index k = 0; k < values.size(); ++k) {
    weights.nodes.push_back(mesh_.cells(k, *cell));
    weights.weights.push_back(values(k));
  }
  return Combine({weights}, {1.0});
}

InterpolationWeights PointLocator::EmbedDirection(const Eigen::Vector3d& point_m,
                                                  const Eigen::Vector3d& direction,
                                                  int* cell) const {
  const Eigen::Vector3d xi = Locate(point_m, cell);
  const Eigen::Matrix3Xd gradients = ShapeGradients(mesh_.element_type(), xi);
  const Eigen::Matrix3d jacobian_m = CellNodes_m(mesh_, *cell) * gradients.transpose();
  const Eigen::VectorXd values = gradients.transpose() * (jacobian_m.inverse() * direction);
  InterpolationWeights weights;
  for (Eigen::Index k = 0; k < values.size(); ++k) {
    weights.nodes.push_back(mesh_.cells(k, *cell));
    weights.weights.push_back(values(k));
  }
  return weights;
}

std::vector<double> PointLocator::Crossings(const Eigen::Vector3d& a_m,
                                            const Eigen::Vector3d& b_m) const {
  constexpr double kSame = 1e-6;  // shorter pieces than this share are no pieces
  const Eigen::Array3i first = GridIndex(a_m.cwiseMin(b_m));
  const Eigen::Array3i last = GridIndex(a_m.cwiseMax(b_m));
  std::set<int> met;
  for (int x = first.x(); x <= last.x(); ++x) {
    for (int y = first.y(); y <= last.y(); ++y) {
      for (int z = first.z(); z <= last.z(); ++z) {
        const std::vector<int>& cells = grid_[GridCell({x, y, z})];
        met.insert(cells.begin(), cells.end());
      }
    }
  }
  std::vector<double> shares{0.0, 1.0};
  for (const int cell : met) {
    // Each coordinate changes linearly on the way.
    const auto on_face = [](double value) { return std::abs(value) < -kInside ? 0.0 : value; };
    const Eigen::Vector4d from = Barycentric(cell, a_m).unaryExpr(on_face);
    const Eigen::Vector4d to = Barycentric(cell, b_m).unaryExpr(on_face);
    double enters = 0.0, leaves = 1.0;
    for (int k = 0; k < 4; ++k) {
      const double zero = from[k] / (from[k] - to[k]);
      if (from[k] < 0.0) enters = to[k] < 0.0 ? 2.0 : std::max(enters, zero);
      if (from[k] >= 0.0 && to[k] < 0.0) leaves = std::min(leaves, zero);
    }
    if (leaves - enters > kSame) shares.insert(shares.end(), {enters, leaves});
  }
  std::sort(shares.begin(), shares.end());
  std::vector<double> distinct{0.0};
  for (const double share : shares) {
    if (share > distinct.back() + kSame && share < 1.0 - kSame) distinct.push_back(share);
  }
  distinct.push_back(1.0);
  return distinct;
}

double PointLocator::Distance_m(const Eigen::Vector3d& point_m) const {
  return HoldingCell(point_m) >= 0 ? 0.0 : surface_.Closest(point_m).distance_m;
}

BodyPoint PointLocator::Embed(const Eigen::Vector3d& point_m) const {
  BodyPoint point;
  point.rest_m = point_m;
  point.weights = Weights(point_m, &point.cell);
  point.distance_m = Distance_m(point_m);
  return point;
}

BodyPoint PointLocator::EmbedBall(const Eigen::Vector3d& centre_m, double radius_m) const {
  PALPATE_CHECK(radius_m >= 0.0, radius_m);
  static const BallRule rule = MakeBallRule();
  BodyPoint ball = Embed(centre_m);
  if (radius_m == 0.0) return ball;
  std::vector<InterpolationWeights> parts;
  for (const Eigen::Vector3d& offset : rule.points) {
    int cell = -1;
    parts.push_back(Weights(centre_m + radius_m * offset, &cell));
  }
  ball.weights = Combine(parts, {rule.weights.begin(), rule.weights.end()});
  return ball;
}

}  // namespace palpate::fem
