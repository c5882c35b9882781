// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/view/frames/page_surface.hpp"

namespace palpate::view {

PageSurface MakePageSurface(const std::string& hash, const Eigen::Matrix3Xd& nodes_m,
                            const Eigen::Matrix3Xi& triangles) {
  PageSurface surface;
  surface.hash = hash;
  surface.node_count = nodes_m.cols();
  constexpr std::uint32_t kNone = 0xFFFFFFFF;
  std::vector<std::uint32_t> number(static_cast<std::size_t>(nodes_m.cols()), kNone);
  surface.triangles.reserve(static_cast<std::size_t>(triangles.size()));
  for (const int node : triangles.reshaped()) {
    std::uint32_t& at = number[static_cast<std::size_t>(node)];
    if (at == kNone) {
      at = static_cast<std::uint32_t>(surface.nodes.size());
      surface.nodes.push_back(node);
      const Eigen::Vector3f rest_m = nodes_m.col(node).cast<float>();
      surface.rest_m.insert(surface.rest_m.end(), rest_m.begin(), rest_m.end());
    }
    surface.triangles.push_back(at);
  }
  return surface;
}

std::vector<float> PositionsOf(const PageSurface& surface, const Eigen::Matrix3Xf& nodes_m) {
  std::vector<float> positions_m;
  positions_m.reserve(3 * surface.nodes.size());
  for (const Eigen::Index node : surface.nodes) {
    const float* at = nodes_m.col(node).data();
    positions_m.insert(positions_m.end(), at, at + 3);
  }
  return positions_m;
}

}  // namespace palpate::view
