// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

namespace palpate::view {

/// The surface of a mesh with its nodes renumbered: the page is sent no others.
struct PageSurface {
  std::string hash;                      ///< of the mesh
  Eigen::Index node_count = 0;           ///< of the whole mesh
  std::vector<Eigen::Index> nodes;       ///< [n] number in the mesh of each node of the surface
  std::vector<std::uint32_t> triangles;  ///< [3 m] into `nodes`
  std::vector<float> rest_m;             ///< [3 n]

  bool empty() const { return nodes.empty(); }
};

/// `nodes_m` [3 x N] at rest, `triangles` [3 x m] into them.
PageSurface MakePageSurface(const std::string& hash, const Eigen::Matrix3Xd& nodes_m,
                            const Eigen::Matrix3Xi& triangles);

/// [3 n] positions of the surface's nodes, of `nodes_m` [3 x N].
std::vector<float> PositionsOf(const PageSurface& surface, const Eigen::Matrix3Xf& nodes_m);

}  // namespace palpate::view
