// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/view/picture/surface_edges.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "libs/core/index.hpp"

namespace palpate::view {

namespace {

const double kCosineOfCrease = std::cos(35.0 * std::numbers::pi / 180.0);

// [3 x m] normals whose length is twice the area.
Eigen::Matrix3Xd FaceNormals(const Eigen::Matrix3Xd& points_m, const Eigen::Matrix3Xi& triangles) {
  Eigen::Matrix3Xd normals(3, triangles.cols());
  for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
    const Eigen::Vector3d a = points_m.col(triangles(0, t));
    const Eigen::Vector3d b = points_m.col(triangles(1, t));
    const Eigen::Vector3d c = points_m.col(triangles(2, t));
    normals.col(t) = (b - a).cross(c - a);
  }
  return normals;
}

bool IsCrease(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const double lengths = a.norm() * b.norm();
  return lengths > 0.0 && a.dot(b) < kCosineOfCrease * lengths;
}

Eigen::Matrix3Xd CornerNormals(const Eigen::Matrix3Xi& triangles, const Eigen::Matrix3Xd& faces,
                               Eigen::Index point_count) {
  std::vector<std::vector<Eigen::Index>> around(static_cast<std::size_t>(point_count));
  for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
    for (int i = 0; i < 3; ++i) {
      around[At(triangles(i, t))].push_back(t);
    }
  }
  Eigen::Matrix3Xd normals(3, 3 * triangles.cols());
  for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
    for (int i = 0; i < 3; ++i) {
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      for (const Eigen::Index other : around[At(triangles(i, t))]) {
        if (!IsCrease(faces.col(t), faces.col(other))) {
          sum += faces.col(other);
        }
      }
      normals.col(3 * t + i) = sum.normalized();
    }
  }
  return normals;
}

Eigen::Matrix2Xi ToMatrix(const std::vector<std::pair<int, int>>& edges) {
  Eigen::Matrix2Xi matrix(2, ToIndex(edges.size()));
  for (std::size_t i = 0; i < edges.size(); ++i) {
    matrix.col(ToIndex(i)) << edges[i].first, edges[i].second;
  }
  return matrix;
}

}  // namespace

SurfaceEdges FindEdges(const Eigen::Matrix3Xd& points_m, const Eigen::Matrix3Xi& triangles,
                       const Camera& camera) {
  const Eigen::Matrix3Xd faces = FaceNormals(points_m, triangles);
  std::map<std::pair<int, int>, std::vector<Eigen::Index>> triangles_of_edge;
  for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
    for (int i = 0; i < 3; ++i) {
      const auto [low, high] = std::minmax(triangles(i, t), triangles((i + 1) % 3, t));
      triangles_of_edge[{low, high}].push_back(t);
    }
  }
  const auto faces_viewer = [&](Eigen::Index t) {
    const Eigen::Vector3d point = points_m.col(triangles(0, t));
    return faces.col(t).dot(camera.TowardViewer(point)) > 0.0;
  };
  std::vector<std::pair<int, int>> all;
  std::vector<std::pair<int, int>> outlines;
  for (const auto& [edge, neighbours] : triangles_of_edge) {
    all.push_back(edge);
    const bool border = neighbours.size() != 2;
    if (border || IsCrease(faces.col(neighbours[0]), faces.col(neighbours[1])) ||
        faces_viewer(neighbours[0]) != faces_viewer(neighbours[1])) {
      outlines.push_back(edge);
    }
  }
  return {CornerNormals(triangles, faces, points_m.cols()), ToMatrix(all), ToMatrix(outlines)};
}

}  // namespace palpate::view
