// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/geometry/closest_point.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "libs/core/check.hpp"
#include "libs/core/index.hpp"
#include "libs/geometry/ray.hpp"

namespace palpate::geometry {

namespace {

constexpr int kTrianglesPerLeaf = 4;
/// A tree halved at every level is never deeper than this for 2^31 triangles.
constexpr int kMaxStack = 64;

/// Barycentric weight of the end of a segment nearest to the point at `along` of `length_squared`.
double ClampedFraction(double along, double length_squared) {
  return length_squared > 0.0 ? std::clamp(along / length_squared, 0.0, 1.0) : 0.0;
}

/// Nearest point on the three edges, for points that do not project into the triangle.
Eigen::Vector3d ClosestPointOnEdges(const std::array<Eigen::Vector3d, 3>& corners_m,
                                    const Eigen::Vector3d& point_m) {
  Eigen::Vector3d best = Eigen::Vector3d::UnitX();
  double best_squared_m2 = std::numeric_limits<double>::infinity();
  for (size_t k = 0; k < 3; ++k) {
    const size_t next = (k + 1) % 3;
    const Eigen::Vector3d edge_m = corners_m[next] - corners_m[k];
    const double t = ClampedFraction((point_m - corners_m[k]).dot(edge_m), edge_m.squaredNorm());
    const double squared_m2 = (corners_m[k] + t * edge_m - point_m).squaredNorm();
    if (squared_m2 < best_squared_m2) {
      best_squared_m2 = squared_m2;
      best.setZero();
      best(ToIndex(k)) = 1.0 - t;
      best(ToIndex(next)) = t;
    }
  }
  return best;
}

}  // namespace

Eigen::Vector3d ClosestPointOnTriangle(const Eigen::Vector3d& a_m, const Eigen::Vector3d& b_m,
                                       const Eigen::Vector3d& c_m, const Eigen::Vector3d& point_m) {
  const Eigen::Vector3d normal = (b_m - a_m).cross(c_m - a_m);
  const double area_squared = normal.squaredNorm();
  if (area_squared > 0.0) {
    const Eigen::Vector3d weights(normal.dot((c_m - b_m).cross(point_m - b_m)) / area_squared,
                                  normal.dot((a_m - c_m).cross(point_m - c_m)) / area_squared,
                                  normal.dot((b_m - a_m).cross(point_m - a_m)) / area_squared);
    if ((weights.array() >= 0.0).all()) return weights / weights.sum();
  }
  return ClosestPointOnEdges({a_m, b_m, c_m}, point_m);
}

bool RayMeets(const TriangleSurface& surface, const Eigen::Vector3d& origin_m,
              const Eigen::Vector3d& direction) {
  return FirstOnRay(surface, origin_m, direction).has_value();
}

SurfaceIndex::SurfaceIndex(TriangleSurface surface) : surface_(std::move(surface)) {
  const int count = surface_.TriangleCount();
  PALPATE_CHECK(count > 0, "a surface needs a triangle");
  Eigen::Matrix3Xd centroids_m(3, count);
  for (int t = 0; t < count; ++t) {
    centroids_m.col(t) =
        (surface_.Corner(t, 0) + surface_.Corner(t, 1) + surface_.Corner(t, 2)) / 3.0;
  }
  order_.resize(static_cast<size_t>(count));
  std::iota(order_.begin(), order_.end(), 0);
  nodes_.reserve(static_cast<size_t>(count));
  Build(0, count, centroids_m);
  Refit(Eigen::Matrix3Xd(surface_.vertices_m));
}

int SurfaceIndex::Build(int first, int count, const Eigen::Matrix3Xd& centroids_m) {
  const int index = static_cast<int>(nodes_.size());
  nodes_.push_back({.box = {}, .left = -1, .right = -1, .first = first, .count = count});
  if (count <= kTrianglesPerLeaf) return index;

  Eigen::Vector3d lower = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector3d upper = -lower;
  const auto begin = order_.begin() + first;
  for (auto triangle = begin; triangle != begin + count; ++triangle) {
    lower = lower.cwiseMin(centroids_m.col(*triangle));
    upper = upper.cwiseMax(centroids_m.col(*triangle));
  }
  Eigen::Index axis = 0;
  (upper - lower).maxCoeff(&axis);
  std::nth_element(begin, begin + count / 2, begin + count, [&](int a, int b) {
    return std::pair(centroids_m(axis, a), a) < std::pair(centroids_m(axis, b), b);
  });
  const int left = Build(first, count / 2, centroids_m);
  const int right = Build(first + count / 2, count - count / 2, centroids_m);
  nodes_[At(index)].left = left;
  nodes_[At(index)].right = right;
  return index;
}

void SurfaceIndex::FitBox(Node* node) const {
  if (node->left >= 0) {
    const Box& a = nodes_[At(node->left)].box;
    const Box& b = nodes_[At(node->right)].box;
    node->box = {a.lower_m.cwiseMin(b.lower_m), a.upper_m.cwiseMax(b.upper_m)};
    return;
  }
  node->box.lower_m.setConstant(std::numeric_limits<double>::infinity());
  node->box.upper_m = -node->box.lower_m;
  for (int k = node->first; k < node->first + node->count; ++k) {
    for (int corner = 0; corner < 3; ++corner) {
      const Eigen::Vector3d point_m = surface_.Corner(order_[At(k)], corner);
      node->box.lower_m = node->box.lower_m.cwiseMin(point_m);
      node->box.upper_m = node->box.upper_m.cwiseMax(point_m);
    }
  }
}

void SurfaceIndex::Refit(const Eigen::Ref<const Eigen::Matrix3Xd>& vertices_m) {
  PALPATE_CHECK(vertices_m.cols() == surface_.vertices_m.cols(), vertices_m.cols());
  surface_.vertices_m = vertices_m;
  for (auto node = nodes_.rbegin(); node != nodes_.rend(); ++node) FitBox(&*node);
}

SurfacePoint SurfaceIndex::ClosestInLeaf(const Node& leaf, const Eigen::Vector3d& point_m) const {
  SurfacePoint best{.distance_m = std::numeric_limits<double>::infinity()};
  for (int k = leaf.first; k < leaf.first + leaf.count; ++k) {
    const int t = order_[At(k)];
    const Eigen::Vector3d weights = ClosestPointOnTriangle(
        surface_.Corner(t, 0), surface_.Corner(t, 1), surface_.Corner(t, 2), point_m);
    const Eigen::Vector3d position_m = weights(0) * surface_.Corner(t, 0) +
                                       weights(1) * surface_.Corner(t, 1) +
                                       weights(2) * surface_.Corner(t, 2);
    const double distance_m = (position_m - point_m).norm();
    if (std::pair(distance_m, t) < std::pair(best.distance_m, best.triangle)) {
      best = {t, weights, position_m, distance_m};
    }
  }
  return best;
}

SurfacePoint SurfaceIndex::Closest(const Eigen::Vector3d& point_m) const {
  SurfacePoint best{.distance_m = std::numeric_limits<double>::infinity()};
  std::array<int, kMaxStack> stack{};
  size_t size = 1;
  while (size > 0) {
    const Node& node = nodes_[At(stack[--size])];
    if (node.box.SquaredDistance_m2(point_m) > best.distance_m * best.distance_m) continue;
    if (node.left < 0) {
      const SurfacePoint candidate = ClosestInLeaf(node, point_m);
      if (std::pair(candidate.distance_m, candidate.triangle) <
          std::pair(best.distance_m, best.triangle)) {
        best = candidate;
      }
      continue;
    }
    const bool left_is_nearer = nodes_[At(node.left)].box.SquaredDistance_m2(point_m) <=
                                nodes_[At(node.right)].box.SquaredDistance_m2(point_m);
    stack[size++] = left_is_nearer ? node.right : node.left;
    stack[size++] = left_is_nearer ? node.left : node.right;
  }
  return best;
}

std::vector<int> SurfaceIndex::TrianglesWithin(const Eigen::Vector3d& point_m,
                                               double radius_m) const {
  std::vector<int> found;
  std::array<int, kMaxStack> stack{};
  size_t size = 1;
  while (size > 0) {
    const Node& node = nodes_[At(stack[--size])];
    if (node.box.SquaredDistance_m2(point_m) > radius_m * radius_m) continue;
    if (node.left >= 0) {
      stack[size++] = node.right;
      stack[size++] = node.left;
      continue;
    }
    for (int k = node.first; k < node.first + node.count; ++k) {
      const Node single{.box = {}, .left = -1, .right = -1, .first = k, .count = 1};
      const SurfacePoint nearest = ClosestInLeaf(single, point_m);
      if (nearest.distance_m <= radius_m) found.push_back(nearest.triangle);
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace palpate::geometry
