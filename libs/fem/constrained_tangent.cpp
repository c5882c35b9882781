// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/constrained_tangent.hpp"

#include <algorithm>
#include <utility>

#include "libs/core/index.hpp"
#include "libs/linalg/cholesky.hpp"

namespace palpate::fem {

namespace {

struct ConstrainedTuning {
  /// Of the preconditioned residual; Newton's method corrects what is left.
  double tolerance = 1e-10;
  int most_iterations = 300;
};
constexpr ConstrainedTuning kConstrainedTuning;

/// Entries without a pattern, so that no direction of interest is left out; the same each time.
Eigen::VectorXd GenericVector(Eigen::Index size) {
  Eigen::VectorXd vector(size);
  unsigned state = 1;
  for (double& entry : vector) {
    state = state * 1664525U + 1013904223U;  // Numerical Recipes' generator
    entry = static_cast<double>(state) / 4294967296.0 - 0.5;
  }
  return vector;
}

}  // namespace

ConstrainedTangent::ConstrainedTangent(Linearisation& linearisation, Eigen::MatrixXd H,
                                       Eigen::VectorXd compliance_m_N)
    : linearisation_(linearisation),
      H_(std::move(H)),
      stiffness_N_m_((compliance_m_N.array() > 0.0).select(compliance_m_N.array().inverse(), 0.0)),
      moved_(H_),
      shift_N_m_(linearisation.matrix().MeanDiagonal() - linearisation.mean_diagonal_N_m()) {
  linearisation_.Solve(moved_);
  schur_ = H_.transpose() * moved_;
  schur_.diagonal() += compliance_m_N;
}

Eigen::VectorXd ConstrainedTangent::Times(const Eigen::VectorXd& v) const {
  const Eigen::VectorXd pulls_N = stiffness_N_m_.cwiseProduct(H_.transpose() * v);
  return linearisation_.matrix().Times(v) - shift_N_m_ * v + H_ * pulls_N;
}

Eigen::VectorXd ConstrainedTangent::MultipliersOf(const Eigen::VectorXd& residual) const {
  return linalg::SolveSymmetric(schur_, Eigen::VectorXd(moved_.transpose() * residual));
}

/// The preconditioned residual along motions that keep the constraints; where these yield, by the
/// inverse of the shifted K + H C^-1 H' (Woodbury).
Eigen::VectorXd ConstrainedTangent::Project(const Eigen::VectorXd& residual) const {
  Eigen::MatrixXd column = residual;
  linearisation_.Solve(column);
  return column.col(0) - moved_ * MultipliersOf(residual);
}

Status ConstrainedTangent::Solve(const Eigen::VectorXd& r, const Eigen::VectorXd& b,
                                 Eigen::VectorXd* dx, Eigen::VectorXd* dlambda) const {
  *dx = moved_ * linalg::SolveSymmetric(schur_, b);
  Eigen::VectorXd residual = r + H_ * stiffness_N_m_.cwiseProduct(b) - Times(*dx);
  Eigen::VectorXd projected = Project(residual);
  Eigen::VectorXd direction = projected;
  double energy = residual.dot(projected);
  const double enough =
      kConstrainedTuning.tolerance * kConstrainedTuning.tolerance * std::max(energy, 0.0);
  for (int iteration = 0; energy > enough; ++iteration) {
    if (iteration == kConstrainedTuning.most_iterations) {
      return {StatusCode::kNotConverged, "conjugate gradients used up"};
    }
    const Eigen::VectorXd bent = Times(direction);
    const double curvature = direction.dot(bent);
    if (!(curvature > 0.0)) return {StatusCode::kNotPositiveDefinite, {}};
    const double length = energy / curvature;
    *dx += length * direction;
    residual -= length * bent;
    projected = Project(residual);
    const double before = energy;
    energy = residual.dot(projected);
    direction = projected + energy / before * direction;
  }
  const Eigen::VectorXd held_N = -MultipliersOf(residual);
  const Eigen::VectorXd yielding_N = stiffness_N_m_.cwiseProduct(b - H_.transpose() * *dx);
  *dlambda = (stiffness_N_m_.array() > 0.0).select(yielding_N, held_N);
  return Status::Ok();
}

std::vector<Eigen::Index> HeldConstraints(const LoadState& loads,
                                          const Eigen::VectorXd& multipliers_N) {
  std::vector<Eigen::Index> held;
  bool can_push = false;
  for (Eigen::Index c = 0; c < loads.CommandCount(); ++c) {
    const ConstraintCommand& command = loads.command(c);
    if (command.mode != ConstraintCommand::Mode::kUpperBound) continue;
    if (multipliers_N[c] <= command.min_multiplier_N) continue;
    if (multipliers_N[c] >= command.max_multiplier_N) continue;
    if (command.compliance_m_N < 0.0) return {};
    can_push = can_push || command.min_multiplier_N < 0.0;
    held.push_back(c);
  }
  if (!can_push) held.clear();
  return held;
}

bool IsStableUnderConstraints(Linearisation& linearisation, const LoadState& loads,
                              const Eigen::VectorXd& x_m, const Eigen::VectorXd& multipliers_N) {
  const std::vector<Eigen::Index> held = HeldConstraints(loads, multipliers_N);
  if (held.empty()) return false;
  Eigen::MatrixXd H(linearisation.Size(), std::ssize(held));
  Eigen::VectorXd compliance_m_N(std::ssize(held));
  Eigen::VectorXd nodal(x_m.size());
  for (std::size_t k = 0; k < held.size(); ++k) {
    compliance_m_N[ToIndex(k)] = loads.command(held[k]).compliance_m_N;
    nodal.setZero();
    linearisation.constraints()[At(held[k])]->AddGradient(x_m, -1.0, nodal);
    linearisation.matrix().Reduce(nodal, H.col(ToIndex(k)));
  }
  Eigen::VectorXd generic = Eigen::VectorXd::Zero(linearisation.Size());
  linearisation.matrix().Reduce(GenericVector(x_m.size()), generic);
  Eigen::VectorXd dx, dlambda;
  return ConstrainedTangent(linearisation, std::move(H), std::move(compliance_m_N))
      .Solve(generic, Eigen::VectorXd::Zero(std::ssize(held)), &dx, &dlambda)
      .ok();
}

}  // namespace palpate::fem
