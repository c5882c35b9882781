// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/fit/force_fitter.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "libs/core/check.hpp"

namespace palpate::force_estimation {

namespace {

using Kind = robot::CableCommand::Kind;

constexpr int kMaxSetChanges = 12;  ///< of taut and slack cables in one linearisation
/// Weight of the error at which the tangent was taken. A live fit is content with the tangent of
/// where the frame began.
constexpr double kTangentErrorWeight = 1e-3;

/// A restoration that needs more load steps than these is halved instead.
constexpr fem::StaticSettings kFollowSettings{.max_newton_iterations = 20, .max_load_steps = 6};

std::vector<robot::ObservationRow> MarkerRows(const robot::RobotModel& model) {
  std::vector<fem::InterpolationWeights> points;
  for (const robot::BodyMarker& marker : model.body().markers) {
    points.push_back(marker.point.weights);
  }
  return robot::RowsOfPoints(points);
}

std::vector<robot::ForceDirection> Directions(const std::vector<FitSite>& sites) {
  std::vector<robot::ForceDirection> directions;
  for (const FitSite& site : sites) {
    for (int i = 0; i < 3; ++i) {
      directions.push_back({site.patch.weights, Eigen::Vector3d::Unit(i)});
    }
  }
  return directions;
}

bool Diverged(const Status& status) {
  return !status.ok() && status.code() != StatusCode::kBudgetReached;
}

}  // namespace

ForceFitter::ForceFitter(robot::RobotModel& model, const Config& config)
    : model_(model),
      config_(config),
      compliance_(model.linearisation(), MarkerRows(model)),
      equilibrium_(model.linearisation(), kFollowSettings),
      elimination_(static_cast<int>(3 * model.body().markers.size()), model.CableCount()),
      weight_N_(Eigen::VectorXd::Zero(model.elastic_body().rest_m().size())),
      external_force_N_(weight_N_),
      new_lambda_a_(model.CableCount()),
      nodal_(weight_N_),
      gradient_(weight_N_),
      cable_gradient_(weight_N_),
      effector_motion_(static_cast<Eigen::Index>(3 * model.body().markers.size())),
      cable_motion_(model.CableCount()),
      responses_(model.linearisation().Size(), 1) {
  fit_.residual_m = Eigen::VectorXd::Zero(effector_motion_.size());
  SetSites({});
}

void ForceFitter::KeepFactor(bool keep) {
  keep_factor_ = keep;
  if (keep) model_.linearisation().KeepSinglePrecision();
}

void ForceFitter::SetRows(std::vector<robot::ObservationRow> rows) {
  const auto count = static_cast<Eigen::Index>(rows.size());
  compliance_.SetEffectors(std::move(rows));
  effector_motion_.resize(count);
  fit_.residual_m = Eigen::VectorXd::Zero(count);
}

void ForceFitter::SetSites(const std::vector<FitSite>& sites) {
  PALPATE_CHECK(3 * sites.size() <= static_cast<size_t>(fem::kMaxQpVariables), sites.size());
  sites_ = sites;
  compliance_.SetForces(Directions(sites));
  const auto forces = static_cast<Eigen::Index>(3 * sites.size());
  new_lambda_f_ = Eigen::VectorXd::Zero(forces);
  fit_.covariance_N2 = Eigen::MatrixXd::Zero(forces, forces);
  fit_.modulus_sensitivity_N = Eigen::VectorXd::Zero(forces);
  prior_information_ = fem::QpMatrix::Zero(forces, forces);
  if (forces != from_.lambda_f_N.size() || from_.x_m.size() == 0) {
    for (FitVariables* variables : {&from_, &step_, &correction_}) {
      variables->x_m = weight_N_;
      variables->lambda_a_N = new_lambda_a_;
      variables->lambda_f_N = new_lambda_f_;
    }
    secants_.SetUp(weight_N_.size(), model_.CableCount(), forces);
  }
  directions_.AskForEverything(sites_);
  last_good_.valid = false;
  columns_current_ = false;
  evaluated_.valid = false;
}

const ForceFit& ForceFitter::Fit(const RowTargets& targets,
                                 const std::vector<robot::CableCommand>& cables, ModelState* state,
                                 const fem::TimeBudget& budget) {
  frame_ = {.targets = &targets, .cables = &cables, .budget = &budget, .state = state};
  fit_.iterations = fit_.chord_steps = fit_.continuation_steps = 0;
  UpdateWeight();
  directions_.AskForEverything(sites_);
  start_ = *state;
  fit_.status = FitWithContinuation();
  if (fit_.status.ok()) fit_.status = Conclude();
  if (Diverged(fit_.status)) *state = start_;
  evaluated_ = *state;
  evaluated_.valid = fit_.status.ok();
  fit_.observability = directions_.observability();
  fit_.unknowns = directions_.unknowns();
  return fit_;
}

/// Newton's steps, as cheap as they may be. Where they diverge, exact ones from where they began:
/// steps with another state's factor may lead where no tangent leads back. Where these diverge,
/// too, one step along equilibria, from which they try again.
Status ForceFitter::FitWithContinuation() {
  Status status = RunLoop(/*careful=*/false);
  if (Diverged(status) && fit_.chord_steps > 0) {
    *frame_.state = start_;
    status = RunLoop(/*careful=*/true);
  }
  if (Diverged(status) && !start_.balanced && last_good_.valid) start_ = last_good_;
  while (Diverged(status) && fit_.continuation_steps < most_continuation_steps_) {
    *frame_.state = start_;
    ++fit_.continuation_steps;
    if (Status restored = Restore(); !restored.ok()) return restored;
    start_ = *frame_.state;
    status = RunLoop(/*careful=*/true);
  }
  return status;
}

Status ForceFitter::RunLoop(bool careful) {
  const bool keep_factor =
      keep_factor_ && !careful && factor_age_cost_ < kFactorWork + kColumnsWork;
  const fem::FrameOutcome outcome = fem::SolveNewton(
      *this,
      {.relative_tolerance = config_.frame_tolerance,
       .max_exact_steps = std::max(1, config_.max_iterations - fit_.iterations),
       .keep_factor = keep_factor,
       .exact_step_cost_s = counts_work_ && !careful ? kFactorWork + kColumnsWork : 0.0},
      *frame_.budget);
  fit_.iterations += outcome.exact_steps;
  fit_.chord_steps += outcome.chord_steps;
  // Beyond the one that every frame needs; once they would have paid a factor, a new one is made.
  if (outcome.exact_steps == 0) factor_age_cost_ += std::max(0, outcome.chord_steps - 1);
  fit_.error = outcome.error;
  frame_.state->balanced = outcome.converged();
  return outcome.status;
}

Status ForceFitter::PrepareExactStep() {
  const ModelState& state = *frame_.state;
  Status status = Linearise(state, /*allow_shift=*/false);
  if (!status.ok()) return status;
  status = SolveInObservableDirections(state);
  if (status.ok()) linearised_error_ = Error(state);
  return status;
}

/// With the factor of an earlier frame: what it was told of the state is new, W is not.
Status ForceFitter::PrepareFrozenFactorStep() {
  secants_.BeginFit();
  if (!factor_known_) return {};
  const ModelState& state = *frame_.state;
  if (!IsEvaluated(state)) {
    UpdateExternalForce(state.lambda_f_N);
    Status evaluated =
        model_.linearisation().UpdateResidual(state.x_m, state.lambda_a_N, external_force_N_);
    if (!evaluated.ok()) return evaluated;
    if (columns_current_) {
      compliance_.ComputeChord(state.x_m, model_.cable_rest_length_m(), state.lambda_a_N,
                               state.lambda_f_N);
      work_ += 1.0;
    } else {
      compliance_.Compute(state.x_m, model_.cable_rest_length_m(), state.lambda_a_N,
                          state.lambda_f_N);
      columns_current_ = true;
      work_ += kColumnsWork;
    }
  }
  compliance_.Observe(state.x_m, model_.cable_rest_length_m());
  const Status status = SolveInObservableDirections(state);
  if (status.ok()) start_error_ = Error(state);
  return status;
}

bool ForceFitter::IsEvaluated(const ModelState& state) const {
  return evaluated_.valid && columns_current_ && evaluated_.lambda_f_N == state.lambda_f_N &&
         evaluated_.lambda_a_N == state.lambda_a_N && evaluated_.x_m == state.x_m;
}

Status ForceFitter::SolveInObservableDirections(const ModelState& state) {
  elimination_.Start(*frame_.cables, state.lambda_a_N);
  Status status = SolveQp(*frame_.targets, *frame_.cables, state);
  if (status.ok() && !frame_.observability_known) {
    directions_.KeepObservable(sites_, Information(*frame_.targets), config_.unobservable_sigma_N);
    frame_.observability_known = true;
    status = SolveQp(*frame_.targets, *frame_.cables, state);
  }
  return status;
}

Status ForceFitter::Try(double length, bool last) {
  const ModelState& state = *frame_.state;
  const double share = StepShare(state);
  step_was_cut_ = share < 1.0;
  length *= share;
  trial_.x_m = state.x_m;
  compliance_.UpdateConfiguration(new_lambda_a_, new_lambda_f_, length, &trial_.x_m);
  trial_.lambda_a_N = state.lambda_a_N + length * (new_lambda_a_ - state.lambda_a_N);
  trial_.lambda_f_N = state.lambda_f_N + length * (new_lambda_f_ - state.lambda_f_N);
  if (keep_factor_ && length == 1.0) Accelerate();
  UpdateExternalForce(trial_.lambda_f_N);
  Status status =
      model_.linearisation().UpdateResidual(trial_.x_m, trial_.lambda_a_N, external_force_N_);
  if (!status.ok()) return status;
  // What the next step would change takes a substitution to know.
  trial_error_ = BalanceError(trial_);
  if (last && trial_error_ > config_.frame_tolerance) return status;
  work_ += 1.0;
  compliance_.ComputeChord(trial_.x_m, model_.cable_rest_length_m(), trial_.lambda_a_N,
                           trial_.lambda_f_N);
  status = SolveQp(*frame_.targets, *frame_.cables, trial_);
  if (!status.ok()) return status;
  trial_error_ = Error(trial_);
  // A factor that is kept stands for itself: how old it is does not say how wrong it is.
  if (!keep_factor_) {
    trial_error_ = std::max(trial_error_, kTangentErrorWeight * linearised_error_);
  }
  return status;
}

void ForceFitter::AcceptTrial() {
  frame_.state->x_m.swap(trial_.x_m);
  frame_.state->lambda_a_N.swap(trial_.lambda_a_N);
  frame_.state->lambda_f_N.swap(trial_.lambda_f_N);
}

/// The forces are changed as far as the residual of the markers falls, the model following in
/// equilibrium.
Status ForceFitter::Restore() {
  const ModelState& state = *frame_.state;
  Status status = Linearise(state, /*allow_shift=*/true);
  if (!status.ok()) return status;
  ++fit_.iterations;
  elimination_.Start(*frame_.cables, state.lambda_a_N);
  status = SolveQp(*frame_.targets, *frame_.cables, state);
  if (!status.ok()) return status;
  constexpr int kHalvings = 8;
  double fraction = 1.0;
  for (int k = 0; k < kHalvings; ++k, fraction *= 0.5) {
    status = StepToEquilibrium(fraction);
    if (status.ok() || status.code() == StatusCode::kBudgetReached) return status;
  }
  return {StatusCode::kNotConverged, {}};
}

Status ForceFitter::StepToEquilibrium(double fraction) {
  ModelState& state = *frame_.state;
  ModelState moved = state;
  moved.lambda_f_N += fraction * (new_lambda_f_ - state.lambda_f_N);
  fem::LoadState loads = model_.Loads(*frame_.cables, {});
  fem::StaticState body{state.x_m, state.lambda_a_N, loads};
  UpdateExternalForce(state.lambda_f_N);
  body.loads.external_force_N = external_force_N_;
  UpdateExternalForce(moved.lambda_f_N);
  loads.external_force_N = external_force_N_;
  Status status = equilibrium_.Solve(loads, &body, *frame_.budget).status;
  if (!status.ok()) return status;
  moved.x_m = body.x_m;
  moved.lambda_a_N = body.multipliers_N;
  moved.balanced = true;
  // The residual before counts only where the state before was an equilibrium.
  const double before = ChiSquared(*frame_.targets, state, &fit_.residual_m);
  const double after = ChiSquared(*frame_.targets, moved, &fit_.residual_m);
  if (state.balanced && after > before * (1.0 + 1e-9)) return {StatusCode::kNotConverged, {}};
  state = std::move(moved);
  return Status::Ok();
}

Status ForceFitter::Linearise(const ModelState& state, bool allow_shift) {
  UpdateExternalForce(state.lambda_f_N);
  factor_known_ = false;
  factor_age_cost_ = 0.0;
  secants_.Forget();
  Status status =
      model_.linearisation().Update(state.x_m, state.lambda_a_N, external_force_N_, allow_shift);
  if (!status.ok()) return status;
  factor_known_ = !model_.linearisation().shifted();
  columns_current_ = true;
  compliance_.Compute(state.x_m, model_.cable_rest_length_m(), state.lambda_a_N, state.lambda_f_N);
  work_ += kFactorWork + kColumnsWork;
  return status;
}

void ForceFitter::UpdateWeight() {
  weight_N_.setZero();
  model_.AddWeight(weight_N_);
}

void ForceFitter::UpdateExternalForce(const Eigen::VectorXd& lambda_f_N) {
  external_force_N_ = weight_N_;
  for (size_t f = 0; f < compliance_.forces().size(); ++f) {
    compliance_.forces()[f].AddForce(lambda_f_N[static_cast<Eigen::Index>(f)], external_force_N_);
  }
}

fem::QpMatrix ForceFitter::Information(const RowTargets& targets) const {
  const Eigen::MatrixXd& G = elimination_.G();
  fem::QpMatrix information = prior_information_;
  for (Eigen::Index i = 0; i < G.cols(); ++i) {
    for (Eigen::Index j = 0; j <= i; ++j) {
      const double sum = (G.col(i).array() * G.col(j).array() * targets.weight.array()).sum();
      information(i, j) += sum;
      if (i != j) information(j, i) += sum;
    }
  }
  return information;
}

/// Eqs. (11), (12) in the observable directions, the taut cables found along with the forces.
Status ForceFitter::SolveQp(const RowTargets& targets,
                            const std::vector<robot::CableCommand>& cables,
                            const ModelState& state) {
  const fem::QpMatrix& basis = directions_.basis();
  const Eigen::Index q = basis.cols();
  fem::BoundedQp qp;
  qp.lower = fem::QpVector::Constant(q, -std::numeric_limits<double>::infinity());
  qp.upper = -qp.lower;
  qp_start_ = basis.transpose() * state.lambda_f_N;
  for (int round = 0; round < kMaxSetChanges; ++round) {
    if (Status status = elimination_.Eliminate(compliance_, cables); !status.ok()) return status;
    const Eigen::MatrixXd& G = elimination_.G();
    fem::QpVector c(G.cols());
    for (Eigen::Index j = 0; j < G.cols(); ++j) {
      c[j] = (G.col(j).array() * targets.weight.array() *
              (elimination_.e0_m() - targets.value_m).array())
                 .sum();
    }
    qp.H = basis.transpose() * Information(targets) * basis;
    qp.c = basis.transpose() * c;
    if (q > 0) {
      const fem::BoundedQpResult solution = fem::SolveBoundedQp(qp, qp_start_);
      if (!solution.status.ok()) return solution.status;
      new_lambda_f_ = basis * solution.x;
    } else {
      new_lambda_f_.setZero();
    }
    if (elimination_.Settle(compliance_, cables, new_lambda_f_)) break;
  }
  elimination_.CableForces(new_lambda_f_, &new_lambda_a_);
  return Status::Ok();
}

double ForceFitter::ChiSquared(const RowTargets& targets, const ModelState& state,
                               Eigen::VectorXd* residual_m) const {
  double sum = 0.0;
  for (size_t r = 0; r < rows().size(); ++r) {
    const auto row = static_cast<Eigen::Index>(r);
    const bool seen = targets.weight[row] > 0.0;
    const double residual = seen ? targets.value_m[row] - rows()[r].Value(state.x_m) : 0.0;
    (*residual_m)[row] = residual;
    sum += targets.weight[row] * residual * residual;
  }
  return sum;
}

}  // namespace palpate::force_estimation
