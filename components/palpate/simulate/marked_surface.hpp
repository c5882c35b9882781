// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "libs/fem/boundary_surface.hpp"

namespace palpate::command {

/// The body's surface under each marker: the facets within the marker's disc, at least the nearest.
class MarkedSurface {
 public:
  /// `markers_m` [3 x markers] on the mesh at rest.
  MarkedSurface(const fem::TetMesh& mesh, const fem::BoundarySurface& boundary,
                const Eigen::Matrix3Xd& markers_m, double radius_m);

  /// [3 x markers] mean over each disc with the nodes at `x_m` [3n]; unit, outward.
  Eigen::Matrix3Xd Normals(const Eigen::VectorXd& x_m) const;

 private:
  std::vector<Eigen::Matrix3Xi> facets_;  ///< [markers] corners
};

}  // namespace palpate::command
