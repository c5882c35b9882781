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

/// How bricks are cut into tetrahedra.
enum class Cut {
  kFive,  ///< neighbours as mirror images, so that no diagonal is preferred
  kSix,   ///< around a diagonal of the brick, mirrored in the middle planes of y and z
};

/// The unit cube as `cells` bricks of tetrahedra; the nodes (mid-edge nodes too) are then moved by
/// `map`, which must keep the orientation. Corner nodes: x runs fastest, then y, then z.
TetMesh MakeGrid(const Eigen::Array3i& cells, ElementType element, const PointMap& map,
                 Cut cut = Cut::kFive);

/// A box from the origin to `size_m`.
TetMesh MakeBox(const Eigen::Array3i& cells, ElementType element, const Eigen::Vector3d& size_m,
                Cut cut = Cut::kFive);

/// The same with every corner node inside moved by up to `fraction` of a brick in each direction
/// (fixed seed); edges stay straight.
TetMesh MakeDistortedBox(const Eigen::Array3i& cells, ElementType element,
                         const Eigen::Vector3d& size_m, double fraction);

/// Indices of the nodes whose rest position passes, rising.
std::vector<int> NodesWhere(const TetMesh& mesh, const PointTest& test);
/// The node nearest to a point.
int NearestNode(const TetMesh& mesh, const Eigen::Vector3d& point_m);

}  // namespace palpate::fem::verification
