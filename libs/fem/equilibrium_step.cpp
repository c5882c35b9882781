// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/equilibrium_step.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "libs/core/check.hpp"
#include "libs/core/index.hpp"
#include "libs/fem/constrained_tangent.hpp"

namespace palpate::fem {

namespace {

using Mode = ConstraintCommand::Mode;

double Value(const Linearisation& linearisation, Eigen::Index c, const Eigen::VectorXd& x_m) {
  return linearisation.constraints()[At(c)]->Value(x_m);
}

bool IsBounded(const LoadState& loads, Eigen::Index c) {
  return loads.command(c).mode == Mode::kUpperBound;
}

/// The step where held constraints keep a body stable whose tangent was shifted
/// (constrained_tangent.hpp). False, and nothing is changed, where they do not, or where a
/// multiplier would leave its bounds.
bool StepAlongConstraints(Linearisation& linearisation, const LoadState& loads,
                          const Eigen::VectorXd& x_m, const Eigen::VectorXd& multipliers_N,
                          const Eigen::MatrixXd& gradients, Eigen::VectorXd* step,
                          Eigen::VectorXd* multipliers) {
  const std::vector<Eigen::Index> held = HeldConstraints(loads, multipliers_N);
  if (held.empty()) return false;
  Eigen::VectorXd missing(std::ssize(held));
  Eigen::VectorXd compliance_m_N(std::ssize(held));
  for (std::size_t k = 0; k < held.size(); ++k) {
    const ConstraintCommand& command = loads.command(held[k]);
    compliance_m_N[ToIndex(k)] = command.compliance_m_N;
    missing[ToIndex(k)] =
        Value(linearisation, held[k], x_m) - command.Bound_m(multipliers_N[held[k]]);
  }
  Eigen::VectorXd dx, change;
  const ConstrainedTangent tangent(linearisation, gradients(Eigen::all, held),
                                   std::move(compliance_m_N));
  if (!tangent.Solve(linearisation.residual_N(), missing, &dx, &change).ok()) return false;
  Eigen::VectorXd reached = multipliers_N;
  for (std::size_t k = 0; k < held.size(); ++k) {
    const ConstraintCommand& command = loads.command(held[k]);
    double& multiplier = reached[held[k]];
    multiplier += change[ToIndex(k)];
    if (multiplier < command.min_multiplier_N || multiplier > command.max_multiplier_N)
      return false;
  }
  *step = dx;
  *multipliers = reached;
  return true;
}

}  // namespace

EquilibriumStep::EquilibriumStep(Linearisation& linearisation)
    : linearisation_(linearisation),
      nodal_(3 * linearisation.body().NodeCount()),
      step_(linearisation.Size()) {
  const auto constraints = ToIndex(linearisation.constraints().size());
  PALPATE_CHECK(constraints <= kMaxQpVariables, constraints);
  columns_.resize(linearisation.Size(), constraints + 1);
  gradients_.resize(linearisation.Size(), constraints);
  multipliers_ = Eigen::VectorXd::Zero(constraints);
  bounded_.resize(static_cast<size_t>(constraints));
}

void EquilibriumStep::ImposeMultipliers(const LoadState& loads, Eigen::VectorXd* multipliers_N) {
  for (Eigen::Index c = 0; c < loads.CommandCount(); ++c) {
    const ConstraintCommand& command = loads.command(c);
    if (command.mode == Mode::kMultiplier) (*multipliers_N)[c] = command.value;
    if (command.mode == Mode::kOff) (*multipliers_N)[c] = 0.0;
  }
}

Status EquilibriumStep::Compute(const LoadState& loads, const Eigen::VectorXd& x_m,
                                const Eigen::VectorXd& multipliers_N, bool allow_shift) {
  factor_ = -1;
  if (Status status =
          linearisation_.Update(x_m, multipliers_N, loads.external_force_N, allow_shift);
      !status.ok()) {
    return status;
  }
  Eigen::Index bounded = 0;
  for (Eigen::Index c = 0; c < loads.CommandCount(); ++c) {
    bounded_[At(c)] = IsBounded(loads, c);
    if (!IsBounded(loads, c)) continue;
    nodal_.setZero();
    linearisation_.constraints()[At(c)]->AddGradient(x_m, -1.0, nodal_);
    linearisation_.matrix().Reduce(nodal_, gradients_.col(c));
    columns_.col(bounded++) = gradients_.col(c);
  }
  columns_.col(bounded) = linearisation_.residual_N();
  linearisation_.Solve(columns_.leftCols(bounded + 1));
  step_ = columns_.col(bounded);
  factor_ = linearisation_.factor_count();
  return SolveMultipliers(loads, x_m, multipliers_N);
}

bool EquilibriumStep::HasTangentFor(const LoadState& loads) const {
  if (factor_ != linearisation_.factor_count() || linearisation_.shifted()) return false;
  for (Eigen::Index c = 0; c < loads.CommandCount(); ++c) {
    if (bounded_[At(c)] != IsBounded(loads, c)) return false;
  }
  return true;
}

Status EquilibriumStep::ComputeChord(const LoadState& loads, const Eigen::VectorXd& x_m,
                                     const Eigen::VectorXd& multipliers_N) {
  step_ = linearisation_.residual_N();
  linearisation_.SolveSingle(step_);
  return SolveMultipliers(loads, x_m, multipliers_N);
}

/// From step_ = K^-1 r on.
Status EquilibriumStep::SolveMultipliers(const LoadState& loads, const Eigen::VectorXd& x_m,
                                         const Eigen::VectorXd& multipliers_N) {
  multipliers_ = multipliers_N;
  Eigen::Index bounded = 0;
  std::array<Eigen::Index, kMaxQpVariables> constraint{};
  for (Eigen::Index c = 0; c < loads.CommandCount(); ++c) {
    if (IsBounded(loads, c)) constraint[At(bounded++)] = c;
  }
  if (bounded == 0) return Status::Ok();
  if (linearisation_.shifted() && StepAlongConstraints(linearisation_, loads, x_m, multipliers_N,
                                                       gradients_, &step_, &multipliers_)) {
    return Status::Ok();
  }
  BoundedQp qp{QpMatrix(bounded, bounded), QpVector(bounded), QpVector(bounded), QpVector(bounded)};
  QpVector present(bounded);
  for (Eigen::Index k = 0; k < bounded; ++k) {
    const Eigen::Index c = constraint[At(k)];
    for (Eigen::Index l = 0; l < bounded; ++l) {
      qp.H(k, l) = gradients_.col(c).dot(columns_.col(l));
    }
    qp.c[k] = gradients_.col(c).dot(step_) + loads.command(c).value - Value(linearisation_, c, x_m);
    qp.lower[k] = loads.command(c).min_multiplier_N;
    qp.upper[k] = loads.command(c).max_multiplier_N;
    present[k] = multipliers_N[c];
  }
  qp.c -= qp.H * present;
  for (Eigen::Index k = 0; k < bounded; ++k) {
    qp.H(k, k) += loads.command(constraint[At(k)]).compliance_m_N;
  }
  const BoundedQpResult solution = SolveBoundedQp(qp, present);
  if (!solution.status.ok()) return solution.status;
  for (Eigen::Index k = 0; k < bounded; ++k) {
    step_ += (solution.x[k] - present[k]) * columns_.col(k);
    multipliers_[constraint[At(k)]] = solution.x[k];
  }
  return Status::Ok();
}

void EquilibriumStep::Apply(double length, const Eigen::VectorXd& x_m,
                            const Eigen::VectorXd& multipliers_N, Eigen::VectorXd* new_x_m,
                            Eigen::VectorXd* new_multipliers_N) const {
  *new_x_m = x_m;
  linearisation_.matrix().AddExpanded(step_, length, *new_x_m);
  *new_multipliers_N = multipliers_N + length * (multipliers_ - multipliers_N);
}

double ConstraintError_m(const Linearisation& linearisation, const LoadState& loads,
                         const Eigen::VectorXd& x_m, const Eigen::VectorXd& multipliers_N) {
  double error = 0.0;
  for (Eigen::Index c = 0; c < loads.CommandCount(); ++c) {
    const ConstraintCommand& command = loads.command(c);
    if (!IsBounded(loads, c)) continue;
    if (multipliers_N[c] >= command.max_multiplier_N) continue;  // the actuator cannot pull harder
    const double excess = Value(linearisation, c, x_m) - command.Bound_m(multipliers_N[c]);
    const bool at_bound = multipliers_N[c] > command.min_multiplier_N;
    error = std::max(error, at_bound ? std::abs(excess) : excess);
  }
  return error;
}

double ForceScale_N(const Linearisation& linearisation, const LoadState& loads,
                    const Eigen::VectorXd& multipliers_N) {
  const double multiplier = multipliers_N.size() > 0 ? multipliers_N.cwiseAbs().maxCoeff() : 0.0;
  return std::max(
      {loads.external_force_N.norm(), linearisation.internal_force_norm_N(), multiplier, 1e-12});
}

double RoundingForce_N(const Linearisation& linearisation, const Eigen::VectorXd& x_m) {
  return 4.0 * std::numeric_limits<double>::epsilon() * x_m.cwiseAbs().maxCoeff() *
         linearisation.mean_diagonal_N_m() * std::sqrt(static_cast<double>(x_m.size()));
}

Status CheckLargestMultipliers(const Linearisation& linearisation, const LoadState& loads,
                               const Eigen::VectorXd& x_m, const Eigen::VectorXd& multipliers_N,
                               double tolerance_m) {
  for (Eigen::Index c = 0; c < loads.CommandCount(); ++c) {
    const ConstraintCommand& command = loads.command(c);
    if (!IsBounded(loads, c)) continue;
    const double excess = Value(linearisation, c, x_m) - command.Bound_m(multipliers_N[c]);
    if (multipliers_N[c] >= command.max_multiplier_N && excess > tolerance_m) {
      return {StatusCode::kTensionLimit, "constraint " + std::to_string(c) + " needs more than " +
                                             std::to_string(command.max_multiplier_N) + " N"};
    }
  }
  return Status::Ok();
}

}  // namespace palpate::fem
