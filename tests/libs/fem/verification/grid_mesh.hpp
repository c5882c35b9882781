// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "libs/fem/tet_mesh.hpp"

namespace palpate::fem::verification {

using PointMap = std::function<Eigen::Vector3d(const Eigen::Vector3d&)>;
using PointTest = std::function<bool(const Eigen::Vector3d&)>;

/// The unit cube as `cells` bricks, each cut into six tetrahedra around its diagonal 000-111, the
/// nodes (mid-edge nodes too) then moved by `map` (orientation preserving). Node order of tet4:
/// x runs fastest, then y, then z.
TetMesh MakeGrid(const Eigen::Array3i& cells, ElementType element, const PointMap& map);

/// A box from the origin to `size_m`.
TetMesh MakeBox(const Eigen::Array3i& cells, ElementType element, const Eigen::Vector3d& size_m);

/// Every node that is not on the surface of the box [0, size] moves by up to `fraction` of a cell
/// in each direction (fixed seed); mid-edge nodes follow their edges. Takes a tet4 grid.
TetMesh Distort(const TetMesh& tet4_box, const Eigen::Array3i& cells, double fraction,
                const Eigen::Vector3d& size_m);

/// Indices of the nodes whose rest position passes, rising.
std::vector<int> NodesWhere(const TetMesh& mesh, const PointTest& test);
/// The node nearest to a point.
int NearestNode(const TetMesh& mesh, const Eigen::Vector3d& point_m);

}  // namespace palpate::fem::verification
