// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/new_robot/flat_faces.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "components/palpate/new_robot/face_patches.hpp"
#include "libs/core/index.hpp"

namespace palpate::command {

namespace {

constexpr double kFlat_rad = 1.0 * std::numbers::pi / 180.0;
constexpr double kLeastShare = 1e-3;

FlatFace FaceOf(const BodyShape& shape, const std::vector<int>& patch) {
  FlatFace face;
  Eigen::Vector3d area_m2 = Eigen::Vector3d::Zero();
  for (const int triangle : patch) {
    const Eigen::Vector3d own_m2 = geometry::TriangleAreaVector_m2(shape.surface, triangle);
    area_m2 += own_m2;
    face.area_m2 += own_m2.norm();
    for (int k = 0; k < 3; ++k) {
      face.centre_m += own_m2.norm() / 3.0 * shape.surface.Corner(triangle, k);
    }
    for (const int node : shape.boundary.faces.col(triangle)) face.nodes.push_back(node);
  }
  face.centre_m /= face.area_m2;
  face.normal = area_m2.normalized();
  return face;
}

/// Whether the patch is flat and no node of the body is before its plane.
bool IsEnd(const BodyShape& shape, const FlatFace& face) {
  const double offset_m = face.normal.dot(face.centre_m);
  for (const int node : face.nodes) {
    if (std::abs(face.normal.dot(shape.mesh.nodes_m.col(node)) - offset_m) > shape.flatness_m()) {
      return false;
    }
  }
  for (int node = 0; node < shape.mesh.NodeCount(); ++node) {
    if (shape.used[At(node)] &&
        face.normal.dot(shape.mesh.nodes_m.col(node)) > offset_m + shape.flatness_m()) {
      return false;
    }
  }
  return true;
}

bool InOnePlane(const BodyShape& shape, const FlatFace& a, const FlatFace& b) {
  return a.normal.dot(b.normal) > std::cos(kFlat_rad) &&
         std::abs(a.normal.dot(a.centre_m - b.centre_m)) <= shape.flatness_m();
}

void Merge(const FlatFace& from, FlatFace* into) {
  const double area_m2 = from.area_m2 + into->area_m2;
  into->centre_m = (from.area_m2 * from.centre_m + into->area_m2 * into->centre_m) / area_m2;
  into->area_m2 = area_m2;
  into->nodes.insert(into->nodes.end(), from.nodes.begin(), from.nodes.end());
}

}  // namespace

std::vector<FlatFace> FindFlatFaces(const BodyShape& shape) {
  const auto pairs = NeighboursAmong(shape.surface, shape.outer_faces);
  const auto patches = FindPatches(shape.outer_faces, pairs, [](const FacePair& pair) {
    return pair.cos_angle > std::cos(kFlat_rad);
  });
  const double least_m2 = kLeastShare * geometry::SurfaceArea_m2(shape.surface);
  std::vector<FlatFace> faces;
  for (const std::vector<int>& patch : patches) {
    const FlatFace face = FaceOf(shape, patch);
    if (face.area_m2 < least_m2 || !IsEnd(shape, face)) continue;
    const auto same = std::find_if(faces.begin(), faces.end(), [&](const FlatFace& other) {
      return InOnePlane(shape, face, other);
    });
    if (same == faces.end()) {
      faces.push_back(face);
    } else {
      Merge(face, &*same);
    }
  }
  for (FlatFace& face : faces) {
    const std::set<int> nodes(face.nodes.begin(), face.nodes.end());
    face.nodes.assign(nodes.begin(), nodes.end());
  }
  std::stable_sort(faces.begin(), faces.end(),
                   [](const FlatFace& a, const FlatFace& b) { return a.area_m2 > b.area_m2; });
  return faces;
}

}  // namespace palpate::command
