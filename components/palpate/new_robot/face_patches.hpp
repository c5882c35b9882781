// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "libs/geometry/triangle_surface.hpp"

namespace palpate::command {

/// Two faces that share an edge.
struct FacePair {
  int first = -1;
  int second = -1;
  double cos_angle = 1.0;  ///< of their normals
  bool convex = false;     ///< the body is below 180 degrees there
};

/// All pairs of neighbours among `faces` (triangles of the surface).
std::vector<FacePair> NeighboursAmong(const geometry::TriangleSurface& surface,
                                      const std::vector<int>& faces);

/// The faces in patches: neighbours for which `same` holds are in one. Each patch rising, the
/// patches by their first face.
std::vector<std::vector<int>> FindPatches(const std::vector<int>& faces,
                                          const std::vector<FacePair>& pairs,
                                          const std::function<bool(const FacePair&)>& same);

}  // namespace palpate::command
