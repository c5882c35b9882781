// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "libs/fem/material.hpp"
#include "libs/fem/tet_mesh.hpp"

namespace palpate::fem {

/// Derivatives of a body's internal forces F_int(x; X, lambda, mu) (elastic_body.hpp) along given
/// directions: of the node positions x, the rest positions X, and the Lame constants of each
/// material. Exact, by forward-mode differentiation of the element integrals; over all nodes, held
/// ones included; without a matrix. One plain loop over the cells each.
class ElementDerivative {
 public:
  /// `mesh` and `material_of_cell` [cells] are those of the ElasticBody.
  ElementDerivative(const TetMesh& mesh, std::vector<int> material_of_cell);

  /// Adds factor * K dx, K = dF_int/dx, to `force_N` [3n]. `x_m`, `dx_m` [3n]; cells whose nodes do
  /// not move cost nothing.
  void AddAlongPositions(const std::vector<Material>& materials, const Eigen::VectorXd& x_m,
                         const Eigen::VectorXd& dx_m, double factor,
                         Eigen::VectorXd& force_N) const;

  /// Adds factor * dF_int/dX [dX] at fixed x. With M = grad dX at an integration point, dF = -F M,
  /// dG_a = -M' G_a and dw = w tr M.
  void AddAlongRestShape(const std::vector<Material>& materials, const Eigen::VectorXd& x_m,
                         const Eigen::VectorXd& dX_m, double factor,
                         Eigen::VectorXd& force_N) const;

  /// F_int is linear in the Lame constants: F_int = sum_k lambda_k L_k + mu_k M_k over the
  /// materials k. Overwrites `per_lambda` and `per_mu` [3n x materials] with L and M, m^2.
  void LameForces(const std::vector<Material>& materials, const Eigen::VectorXd& x_m,
                  Eigen::MatrixXd* per_lambda_m2, Eigen::MatrixXd* per_mu_m2) const;

  /// Derivative of each node's share of the volume, integral of N_i, along dX [3n]; [n], m^3.
  Eigen::VectorXd NodalVolumeAlong(const Eigen::VectorXd& dX_m) const;
  /// Integral of N_i over the cells of one material, or of all for -1; [n], m^3.
  Eigen::VectorXd NodalVolume_m3(int material) const;

 private:
  /// What is known of a cell of so many nodes.
  template <int kNodes>
  struct Cell;

  template <int kNodes>
  void AlongPositions(const std::vector<Material>& materials, const Eigen::VectorXd& x_m,
                      const Eigen::VectorXd& dx_m, double factor, Eigen::VectorXd& force_N) const;
  template <int kNodes>
  void AlongRestShape(const std::vector<Material>& materials, const Eigen::VectorXd& x_m,
                      const Eigen::VectorXd& dX_m, double factor, Eigen::VectorXd& force_N) const;
  template <int kNodes>
  void LameForcesOf(const std::vector<Material>& materials, const Eigen::VectorXd& x_m,
                    Eigen::MatrixXd* per_lambda_m2, Eigen::MatrixXd* per_mu_m2) const;
  const Material& MaterialOf(const std::vector<Material>& materials, int cell) const;
  bool Moves(int cell, const Eigen::VectorXd& nodal) const;

  TetMesh mesh_;
  std::vector<int> material_of_cell_;
  int points_ = 0;                 ///< integration points of a cell
  std::vector<double> gradients_;  ///< [cells][points][nodes][3] dN/dX, 1/m
  std::vector<double> weights_;    ///< [cells][points] rest volumes, m^3
};

}  // namespace palpate::fem
