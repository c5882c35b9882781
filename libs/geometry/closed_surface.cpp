// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/geometry/closed_surface.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>
#include <vector>

#include "libs/core/index.hpp"
#include "libs/geometry/box.hpp"

namespace palpate::geometry {

namespace {

using Edge = std::pair<int, int>;

/// Sine of the angle between a segment and a triangle's plane below which they count as parallel.
constexpr double kParallel = 1e-9;

Eigen::Matrix3d CornersOf(const TriangleSurface& surface, int triangle) {
  Eigen::Matrix3d corners_m;
  for (int k = 0; k < 3; ++k) corners_m.col(k) = surface.Corner(triangle, k);
  return corners_m;
}

/// Moeller and Trumbore 1997, for a segment instead of a ray.
bool SegmentMeets(const Eigen::Vector3d& from_m, const Eigen::Vector3d& to_m,
                  const Eigen::Matrix3d& corners_m) {
  const Eigen::Vector3d along_m = to_m - from_m;
  const Eigen::Vector3d u_m = corners_m.col(1) - corners_m.col(0);
  const Eigen::Vector3d v_m = corners_m.col(2) - corners_m.col(0);
  const Eigen::Vector3d normal = along_m.cross(v_m);
  const double determinant = u_m.dot(normal);
  // Nearly parallel, where only rounding would decide: another edge cuts, or none.
  if (std::abs(determinant) <= kParallel * along_m.norm() * u_m.cross(v_m).norm()) return false;
  const Eigen::Vector3d offset_m = from_m - corners_m.col(0);
  const double u = offset_m.dot(normal) / determinant;
  if (u < 0.0 || u > 1.0) return false;
  const Eigen::Vector3d across = offset_m.cross(u_m);
  const double v = along_m.dot(across) / determinant;
  if (v < 0.0 || u + v > 1.0) return false;
  const double t = v_m.dot(across) / determinant;
  return t >= 0.0 && t <= 1.0;
}

bool Cut(const Eigen::Matrix3d& a_m, const Eigen::Matrix3d& b_m) {
  for (int k = 0; k < 3; ++k) {
    const int next = (k + 1) % 3;
    if (SegmentMeets(a_m.col(k), a_m.col(next), b_m)) return true;
    if (SegmentMeets(b_m.col(k), b_m.col(next), a_m)) return true;
  }
  return false;
}

bool ShareVertex(const Eigen::Vector3i& a, const Eigen::Vector3i& b) {
  for (const int vertex : a) {
    if ((b.array() == vertex).any()) return true;
  }
  return false;
}

}  // namespace

std::optional<UnmatchedEdge> FindUnmatchedEdge(const Eigen::Matrix3Xi& triangles) {
  std::map<Edge, std::vector<int>> triangles_at;
  for (int t = 0; t < triangles.cols(); ++t) {
    for (int k = 0; k < 3; ++k) {
      triangles_at[{triangles(k, t), triangles((k + 1) % 3, t)}].push_back(t);
    }
  }
  for (int t = 0; t < triangles.cols(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const Edge edge{triangles(k, t), triangles((k + 1) % 3, t)};
      const std::vector<int>& alike = triangles_at.at(edge);
      const auto back = triangles_at.find({edge.second, edge.first});
      if (back != triangles_at.end() && back->second.size() == alike.size()) continue;
      const bool twice = alike.size() > 1;
      return UnmatchedEdge{.vertices = {edge.first, edge.second},
                           .triangle = alike.front(),
                           .other = twice ? alike[1] : -1};
    }
  }
  return std::nullopt;
}

/// Sweeps over x; only triangles whose boxes meet are looked at.
std::optional<std::array<int, 2>> FindCuttingTriangles(const TriangleSurface& surface) {
  const int count = surface.TriangleCount();
  std::vector<Box> boxes;
  for (int t = 0; t < count; ++t) boxes.push_back(BoundingBox(CornersOf(surface, t)));
  std::vector<int> order(At(count));
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    return std::pair(boxes[At(a)].lower_m.x(), a) < std::pair(boxes[At(b)].lower_m.x(), b);
  });
  std::optional<std::array<int, 2>> found;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const Box& box = boxes[At(order[i])];
    for (std::size_t j = i + 1; j < order.size(); ++j) {
      const Box& other = boxes[At(order[j])];
      if (other.lower_m.x() > box.upper_m.x()) break;
      const bool apart = (other.lower_m.array() > box.upper_m.array()).any() ||
                         (box.lower_m.array() > other.upper_m.array()).any();
      if (apart) continue;
      const auto [a, b] = std::minmax(order[i], order[j]);
      if (ShareVertex(surface.triangles.col(a), surface.triangles.col(b))) continue;
      if (found && *found <= std::array{a, b}) continue;
      if (Cut(CornersOf(surface, a), CornersOf(surface, b))) found = {a, b};
    }
  }
  return found;
}

}  // namespace palpate::geometry
