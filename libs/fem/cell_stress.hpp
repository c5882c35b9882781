// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "libs/fem/material.hpp"
#include "libs/fem/tet_mesh.hpp"

namespace palpate::fem {

/// Stress and strain of each cell as the mean over its integration points, weighted by volume.
struct CellStress {
  Eigen::VectorXd von_mises_Pa;  ///< [cells] of the Cauchy stress, >= 0
  /// [cells] Largest principal stretch minus 1; negative where every direction is compressed.
  Eigen::VectorXd largest_strain;
};

/// At the positions `x_m` [3n] of the nodes; `material_of_cell` [cells] is an index into
/// `materials`. Both results are unchanged by a rigid motion. A linear material has a stress to
/// first order in its strains and rotations (point_stress.hpp).
CellStress EvaluateCellStress(const TetMesh& mesh, const std::vector<Material>& materials,
                              const std::vector<int>& material_of_cell, const Eigen::VectorXd& x_m);

}  // namespace palpate::fem
