// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "libs/fem/elastic_body.hpp"
#include "libs/fem/node_matrix.hpp"
#include "libs/fem/point_stress.hpp"
#include "libs/fem/prony_term.hpp"

namespace palpate::fem {

/// The history of a material: finite linear viscoelasticity on the second Piola-Kirchhoff stress
/// (J. C. Simo, On a fully three-dimensional finite-strain viscoelastic damage model, Comput.
/// Methods Appl. Mech. Eng. 60, 1987),
///   S = S_inf + sum H_k,  H_k(t + h) = exp(-h/tau_k) H_k + g_k gamma_k (S_inf(t + h) - S_inf(t)),
///   gamma = (1 - exp(-h/tau)) tau / h,
/// and the stiffness part of Rayleigh's damping in a form that a rotation does not see, a branch of
/// vanishing tau: S_v = beta dS_inf/dt. Within a step both are a multiple of the elastic forces and
/// a stress that stays with the material:
///   F(x) = scale() F_elastic(x) + history() x.
class Viscosity {
 public:
  Viscosity(const TetMesh& mesh, const std::vector<int>& material_of_cell,
            std::vector<PronyTerm> prony, double stiffness_damping_s);

  /// Whether it has a history; without, scale() is 1 and history() is not used.
  bool active() const { return !prony_.empty() || stiffness_damping_s_ > 0.0; }
  void BindTo(const StiffnessMatrix& stiffness) { history_.BindTo(stiffness); }

  /// Fully relaxed at the positions `x_m` [3n]. `factor_of_cell` [cells] of the moduli.
  void Reset(const std::vector<Material>& materials, const Eigen::VectorXd& factor_of_cell,
             const Eigen::VectorXd& x_m);
  /// For the balance `later_s` > 0 after the state that Reset or Advance left.
  void Prepare(double later_s);
  double scale() const { return scale_; }
  const NodeMatrix& history() const { return history_; }
  /// On by `h_s`, to the positions `x_m`.
  void Advance(const std::vector<Material>& materials, const Eigen::VectorXd& factor_of_cell,
               const Eigen::VectorXd& x_m, double h_s);

 private:
  using Stresses = Eigen::Matrix<double, 6, Eigen::Dynamic>;

  PointStress points_;
  NodeMatrix history_;
  std::vector<PronyTerm> prony_;
  double stiffness_damping_s_;
  double scale_ = 1.0;
  Stresses elastic_Pa_;              ///< S_inf now
  std::vector<Stresses> branch_Pa_;  ///< H_k now
  Stresses work_Pa_;
};

}  // namespace palpate::fem
