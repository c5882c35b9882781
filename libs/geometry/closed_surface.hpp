// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <array>
#include <optional>

#include "libs/geometry/triangle_surface.hpp"

namespace palpate::geometry {

/// What keeps a surface from being the wall of a volume.
struct UnmatchedEdge {
  std::array<int, 2> vertices;  ///< in the direction of its triangle
  int triangle = -1;
  int other = -1;  ///< a triangle that has the edge in the same direction; -1: none has it
};

/// The first edge, in the order of triangles, that is not passed as often in one direction as in
/// the other; nullopt where the surface is closed and its triangles are turned alike.
std::optional<UnmatchedEdge> FindUnmatchedEdge(const Eigen::Matrix3Xi& triangles);

/// Two triangles without a common vertex that cut each other, the lowest pair; nullopt where there
/// are none. Touching counts.
std::optional<std::array<int, 2>> FindCuttingTriangles(const TriangleSurface& surface);

}  // namespace palpate::geometry
