// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "libs/fem/material.hpp"
#include "libs/fem/node_matrix.hpp"
#include "libs/fem/tet_mesh.hpp"

namespace palpate::fem {

/// Second Piola-Kirchhoff stresses at the integration points of a body, and the forces of such
/// stresses that are kept while the body moves on: what a material with a memory needs beside
/// ElasticBody, which has the elastic forces only. One plain loop over the points each.
class PointStress {
 public:
  /// `mesh` and `material_of_cell` [cells] are those of the ElasticBody.
  PointStress(const TetMesh& mesh, std::vector<int> material_of_cell);

  int PointCount() const { return static_cast<int>(weights_.size()); }

  /// Overwrites `stress_Pa` [6 x points] (xx, yy, zz, xy, yz, zx) with S at the positions `x_m`
  /// [3n]: of the materials, times `factor_of_cell` [cells]. A linear material, whose stress is not
  /// frame-indifferent, has one to first order in its strains and turns.
  void Evaluate(const std::vector<Material>& materials, const Eigen::VectorXd& factor_of_cell,
                const Eigen::VectorXd& x_m,
                Eigen::Matrix<double, 6, Eigen::Dynamic>* stress_Pa) const;

  /// Sets `matrix` to L, N/m, with L_ab = sum_q w_q grad N_a . S_q grad N_b: a stress S that stays
  /// with the material gives the nodal forces L x wherever the nodes x are, since F S = sum x_b
  /// (S grad N_b)'.
  void SetMatrix(const Eigen::Matrix<double, 6, Eigen::Dynamic>& stress_Pa,
                 NodeMatrix* matrix) const;

  /// Adds those forces to `force_N` [3n], without the matrix.
  void AddForces(const Eigen::Matrix<double, 6, Eigen::Dynamic>& stress_Pa,
                 const Eigen::VectorXd& x_m, Eigen::VectorXd* force_N) const;

 private:
  using Gradients = Eigen::Map<const Eigen::Matrix3Xd>;
  using CellNodes = Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 10>;

  /// [3 x nodes of the cell]
  CellNodes NodesOf(int cell, const Eigen::VectorXd& x_m) const;
  Gradients GradientsAt(int point) const {
    return {gradients_.data() + static_cast<size_t>(3 * nodes_per_cell_ * point), 3,
            nodes_per_cell_};
  }

  Eigen::MatrixXi cells_;
  std::vector<int> material_of_cell_;
  int nodes_per_cell_;
  int points_per_cell_;
  std::vector<double> gradients_;  ///< [cells][points][nodes][3] dN/dX, 1/m
  std::vector<double> weights_;    ///< [cells][points] rest volumes, m^3
};

}  // namespace palpate::fem
