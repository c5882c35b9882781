// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/new_robot/face_patches.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <unordered_map>
#include <utility>

#include "libs/core/index.hpp"

namespace palpate::command {

namespace {

struct EdgeOfFace {
  std::pair<int, int> nodes;
  int face;
  auto operator<=>(const EdgeOfFace&) const = default;
};

Eigen::Vector3d CentroidOf(const geometry::TriangleSurface& surface, int face) {
  return (surface.Corner(face, 0) + surface.Corner(face, 1) + surface.Corner(face, 2)) / 3.0;
}

class Roots {
 public:
  explicit Roots(const std::vector<int>& faces) {
    for (const int face : faces) parent_[face] = face;
  }
  int Of(int face) {
    while (parent_[face] != face) {
      parent_[face] = parent_[parent_[face]];
      face = parent_[face];
    }
    return face;
  }
  void Join(int a, int b) {
    const int first = Of(a), second = Of(b);
    parent_[std::max(first, second)] = std::min(first, second);
  }

 private:
  std::unordered_map<int, int> parent_;
};

}  // namespace

std::vector<FacePair> NeighboursAmong(const geometry::TriangleSurface& surface,
                                      const std::vector<int>& faces) {
  std::vector<EdgeOfFace> edges;
  for (const int face : faces) {
    for (int k = 0; k < 3; ++k) {
      const int a = surface.triangles(k, face), b = surface.triangles((k + 1) % 3, face);
      edges.push_back({{std::min(a, b), std::max(a, b)}, face});
    }
  }
  std::sort(edges.begin(), edges.end());
  std::vector<FacePair> pairs;
  for (size_t k = 1; k < edges.size(); ++k) {
    if (edges[k].nodes != edges[k - 1].nodes) continue;
    const int f = edges[k - 1].face, g = edges[k].face;
    const Eigen::Vector3d normal = geometry::TriangleNormal(surface, f);
    const double bend = normal.dot(CentroidOf(surface, g) - CentroidOf(surface, f));
    pairs.push_back({f, g, normal.dot(geometry::TriangleNormal(surface, g)), bend < 0.0});
  }
  return pairs;
}

std::vector<std::vector<int>> FindPatches(const std::vector<int>& faces,
                                          const std::vector<FacePair>& pairs,
                                          const std::function<bool(const FacePair&)>& same) {
  Roots roots(faces);
  for (const FacePair& pair : pairs) {
    if (same(pair)) roots.Join(pair.first, pair.second);
  }
  std::map<int, std::vector<int>> patches;
  for (const int face : faces) patches[roots.Of(face)].push_back(face);
  std::vector<std::vector<int>> found;
  for (auto& [root, patch] : patches) {
    std::sort(patch.begin(), patch.end());
    found.push_back(std::move(patch));
  }
  return found;
}

}  // namespace palpate::command
