// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/linearisation.hpp"

#include "libs/core/check.hpp"
#include "libs/core/index.hpp"

namespace palpate::fem {

namespace {

NodePairs AllPairs(const ElasticBody& body, const std::vector<ScalarConstraint*>& constraints) {
  NodePairs pairs = body.CoupledPairs();
  for (const ScalarConstraint* constraint : constraints) {
    const NodePairs own = constraint->CoupledPairs();
    pairs.insert(pairs.end(), own.begin(), own.end());
  }
  return pairs;
}

}  // namespace

Linearisation::Linearisation(ElasticBody& body, std::vector<ScalarConstraint*> constraints,
                             const FixedDirections& fixed, const SolverSettings& settings)
    : body_(body),
      constraints_(std::move(constraints)),
      fixed_(fixed),
      matrix_(fixed, AllPairs(body, constraints_)),
      team_(std::make_shared<ThreadTeam>(settings.threads)),
      solver_(MakeSolver(settings.solver, matrix_.Pattern(), *team_)),
      nodal_(Eigen::VectorXd::Zero(3 * body.NodeCount())),
      residual_(Eigen::VectorXd::Zero(matrix_.Size())) {
  PALPATE_CHECK(fixed.cols() == body.NodeCount(), fixed.cols(), body.NodeCount());
  body_.BindTo(matrix_, team_);
  for (ScalarConstraint* constraint : constraints_) constraint->BindTo(matrix_);
}

Status Linearisation::Check() const {
  if (!residual_.allFinite()) return {StatusCode::kInvalidInput, "the residual is not finite"};
  if (!(min_J_ > 0.0)) return {StatusCode::kInverted, {}};
  return Status::Ok();
}

Status Linearisation::UpdateResidual(const Eigen::VectorXd& x_m,
                                     const Eigen::VectorXd& multipliers_N,
                                     const Eigen::VectorXd& external_force_N) {
  nodal_.setZero();
  min_J_ = body_.AddForces(x_m, nodal_);
  internal_norm_ = nodal_.norm();
  for (size_t c = 0; c < constraints_.size(); ++c) {
    constraints_[c]->AddGradient(x_m, multipliers_N[ToIndex(c)], nodal_);
  }
  nodal_ = external_force_N - nodal_;
  matrix_.Reduce(nodal_, residual_);
  return Check();
}

Status Linearisation::Update(const Eigen::VectorXd& x_m, const Eigen::VectorXd& multipliers_N,
                             const Eigen::VectorXd& external_force_N, bool allow_shift) {
  nodal_.setZero();
  shifted_ = false;
  min_J_ = body_.AddForcesAndSetTangent(x_m, nodal_, matrix_);
  internal_norm_ = nodal_.norm();
  for (size_t c = 0; c < constraints_.size(); ++c) {
    const double multiplier = multipliers_N[ToIndex(c)];
    constraints_[c]->AddGradient(x_m, multiplier, nodal_);
    if (multiplier != 0.0) constraints_[c]->AddCurvature(x_m, multiplier, matrix_);
  }
  nodal_ = external_force_N - nodal_;
  matrix_.Reduce(nodal_, residual_);
  matrix_.FixSingleDirections();
  if (Status state = Check(); !state.ok()) return state;

  ++factor_count_;
  mean_diagonal_ = matrix_.MeanDiagonal();
  Status factorised = solver_->Factorize(matrix_.Values());
  constexpr double kSmallestShift = 1e-4;
  constexpr double kLargestShift = 1e2;
  for (double shift = kSmallestShift;
       allow_shift && factorised.code() == StatusCode::kNotPositiveDefinite &&
       shift <= kLargestShift;
       shift *= 10.0) {
    matrix_.AddRelativeShift(shift);
    shifted_ = true;
    factorised = solver_->Factorize(matrix_.Values());
  }
  return factorised;
}

}  // namespace palpate::fem
