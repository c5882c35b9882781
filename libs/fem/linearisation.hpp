// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "libs/core/status.hpp"
#include "libs/core/thread_team.hpp"
#include "libs/fem/elastic_body.hpp"
#include "libs/fem/scalar_constraint.hpp"
#include "libs/fem/sparse/solver_settings.hpp"
#include "libs/fem/stiffness_matrix.hpp"

namespace palpate::fem {

using FixedDirections = Eigen::Matrix<bool, 3, Eigen::Dynamic>;  ///< [3 x nodes]

/// Residual and factorised tangent of body and constraints at one state: what eqs. (1) and (2) of
/// the paper become after sign (elastic_body.hpp),
///   r(x, lambda) = f_ext - F_int(x) - sum lambda_c dg_c/dx,   K dx = r.
/// Owns the matrix, its pattern and its factor; nothing is allocated after the first Update.
class Linearisation {
 public:
  /// `body` and `constraints` are bound to this object's matrix and must outlive it. Throws
  /// InputError where there is no solver of that name.
  Linearisation(ElasticBody& body, std::vector<ScalarConstraint*> constraints,
                const FixedDirections& fixed, const SolverSettings& settings = {});

  int Size() const { return matrix_.Size(); }  ///< rows of the reduced system
  const StiffnessMatrix& matrix() const { return matrix_; }
  const SparseSolver& solver() const { return *solver_; }
  const std::vector<ScalarConstraint*>& constraints() const { return constraints_; }
  ElasticBody& body() const { return body_; }
  const FixedDirections& fixed() const { return fixed_; }

  /// Assembles r and K at the state and factorises K. Where K has no Cholesky factor, a multiple of
  /// the identity is added if `allow_shift`, so that a descent step exists: shifted().
  Status Update(const Eigen::VectorXd& x_m, const Eigen::VectorXd& multipliers_N,
                const Eigen::VectorXd& external_force_N, bool allow_shift = false);

  /// Only r and the smallest det F, without a tangent. kInverted or kInvalidInput on failure.
  Status UpdateResidual(const Eigen::VectorXd& x_m, const Eigen::VectorXd& multipliers_N,
                        const Eigen::VectorXd& external_force_N);

  const Eigen::VectorXd& residual_N() const { return residual_; }  ///< [Size()]
  /// r over all nodes [3n]; in fixed directions minus the support's reaction.
  const Eigen::VectorXd& nodal_residual_N() const { return nodal_; }
  double internal_force_norm_N() const { return internal_norm_; }
  double min_J() const { return min_J_; }
  bool shifted() const { return shifted_; }
  /// How many times K was factorised: equal while the factor is the same one.
  int factor_count() const { return factor_count_; }
  /// Of K's diagonal at the last Update, N/m.
  double mean_diagonal_N_m() const { return mean_diagonal_; }

  /// Overwrites each column [Size()] of `columns` with K^-1 column. After a successful Update.
  void Solve(Eigen::Ref<Eigen::MatrixXd> columns) { solver_->Solve(columns); }
  /// SparseSolver::KeepSinglePrecision, and Solve by it for steps that the next residual corrects.
  void KeepSinglePrecision() { solver_->KeepSinglePrecision(); }
  void SolveSingle(Eigen::Ref<Eigen::MatrixXd> columns) { solver_->SolveSingle(columns); }

 private:
  Status Check() const;

  ElasticBody& body_;
  std::vector<ScalarConstraint*> constraints_;
  FixedDirections fixed_;
  StiffnessMatrix matrix_;
  std::shared_ptr<ThreadTeam> team_;
  std::unique_ptr<SparseSolver> solver_;
  Eigen::VectorXd nodal_;
  Eigen::VectorXd residual_;
  double internal_norm_ = 0.0;
  double min_J_ = 0.0;
  double mean_diagonal_ = 0.0;
  bool shifted_ = false;
  int factor_count_ = 0;
};

}  // namespace palpate::fem
