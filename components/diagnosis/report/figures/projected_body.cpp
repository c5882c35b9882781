// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/report/figures/projected_body.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "libs/core/index.hpp"

namespace palpate::diagnosis {

namespace {

using Triangles = std::vector<std::array<int, 3>>;

constexpr plot::Color kLit = plot::FromHex(0xE9EFF4);
constexpr plot::Color kDark = plot::FromHex(0xB4C2CE);
/// Cells of the grid on which nodes are joined, along the body's longest side.
constexpr double kCells = 44.0;
/// Surfaces of so many triangles are drawn as they are.
constexpr std::size_t kFewTriangles = 4000;

struct Surface {
  Eigen::Matrix3Xd nodes_m;
  Triangles triangles;
};

/// Joins the nodes of each element of a grid: what is smaller cannot be seen, and makes the file
/// large.
Surface Coarsened(const Eigen::Matrix3Xd& nodes_m, const Triangles& triangles) {
  if (triangles.size() <= kFewTriangles) return {nodes_m, triangles};
  const Eigen::Vector3d low_m = nodes_m.rowwise().minCoeff();
  const double cell_m = (nodes_m.rowwise().maxCoeff() - low_m).maxCoeff() / kCells;
  std::map<std::tuple<int, int, int>, int> found;
  std::vector<int> joined(static_cast<std::size_t>(nodes_m.cols()));
  std::vector<Eigen::Vector4d> sums;
  for (Eigen::Index n = 0; n < nodes_m.cols(); ++n) {
    const Eigen::Vector3i cell = ((nodes_m.col(n) - low_m) / cell_m).cast<int>();
    const auto [entry, is_new] =
        found.try_emplace({cell.x(), cell.y(), cell.z()}, static_cast<int>(sums.size()));
    if (is_new) sums.emplace_back(Eigen::Vector4d::Zero());
    sums[At(entry->second)] += nodes_m.col(n).homogeneous();
    joined[At(n)] = entry->second;
  }
  Surface surface;
  surface.nodes_m.resize(3, ToIndex(sums.size()));
  for (std::size_t n = 0; n < sums.size(); ++n) {
    surface.nodes_m.col(ToIndex(n)) = sums[n].hnormalized();
  }
  std::set<std::array<int, 3>> kept;
  for (const auto& [a, b, c] : triangles) {
    const std::array<int, 3> corners = {joined[At(a)], joined[At(b)], joined[At(c)]};
    const bool flat =
        corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0];
    std::array<int, 3> sorted = corners;
    std::sort(sorted.begin(), sorted.end());
    if (!flat && kept.insert(sorted).second) surface.triangles.push_back(corners);
  }
  return surface;
}

Eigen::Vector3d DoubledNormal(const Surface& surface, const std::array<int, 3>& corners) {
  const auto node = [&](int i) { return surface.nodes_m.col(corners[At(i)]); };
  return (node(1) - node(0)).cross(node(2) - node(0));
}

/// +1 where the corners run anticlockwise seen from outside, else -1.
double Orientation(const Surface& surface) {
  double volume_m3 = 0.0;
  for (const auto& corners : surface.triangles) {
    volume_m3 += DoubledNormal(surface, corners).dot(surface.nodes_m.col(corners[0]));
  }
  return volume_m3 < 0.0 ? -1.0 : 1.0;
}

struct Facet {
  double depth_m = 0.0;
  std::vector<plot::SvgPoint> corners;
  plot::Color color;
};

}  // namespace

std::vector<BodyView> BodyViews(const Eigen::Matrix3Xd& points_m) {
  std::vector<BodyView> views = {{0, 1, 2, 1.0, "from above"},
                                 {0, 2, 1, -1.0, "from the front (-y)"},
                                 {1, 2, 0, 1.0, "from the side (+x)"}};
  const Eigen::Vector3d size_m = points_m.rowwise().maxCoeff() - points_m.rowwise().minCoeff();
  std::stable_sort(views.begin(), views.end(), [&](const BodyView& a, const BodyView& b) {
    return size_m[a.right] * size_m[a.up] > 1.05 * size_m[b.right] * size_m[b.up];
  });
  return views;
}

void DrawBody(const Eigen::Matrix3Xd& surface_m, const Triangles& triangles, const BodyView& view,
              const plot::PlotArea& area, plot::SvgDocument* svg) {
  const Surface surface = Coarsened(surface_m, triangles);
  const double orientation = Orientation(surface);
  Eigen::Vector3d light = Eigen::Vector3d::Zero();
  light[view.towards] = view.sign;
  light[view.up] = 0.5;
  light[view.right] = -0.35;
  light.normalize();
  std::vector<Facet> facets;
  for (const auto& corners : surface.triangles) {
    const Eigen::Vector3d normal = orientation * DoubledNormal(surface, corners).stableNormalized();
    if (!(view.sign * normal[view.towards] > 0.0)) continue;
    Facet facet;
    for (const int corner : corners) {
      const Eigen::Vector3d point_m = surface.nodes_m.col(corner);
      facet.corners.push_back(area.Place(1e3 * point_m[view.right], 1e3 * point_m[view.up]));
      facet.depth_m += view.sign * point_m[view.towards] / 3.0;
    }
    facet.color = plot::Mix(kDark, kLit, std::max(0.0, normal.dot(light)));
    facets.push_back(facet);
  }
  std::stable_sort(facets.begin(), facets.end(),
                   [](const Facet& a, const Facet& b) { return a.depth_m < b.depth_m; });
  for (const Facet& facet : facets) svg->Facet(facet.corners, facet.color);
}

}  // namespace palpate::diagnosis
