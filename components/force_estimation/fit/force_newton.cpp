// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/fit/force_newton.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "libs/core/index.hpp"
#include "libs/core/text.hpp"

namespace palpate::force_estimation {

namespace {

using Kind = robot::ActuatorCommand::Kind;

struct ForceNewtonTuning {
  /// Weight of the error of the state at which the tangent was taken. Larger: intervals of the
  /// fitted state itself, for more factorisations. Smaller: fewer factorisations, intervals of a
  /// state further away.
  double tangent_error_weight = 1e-3;
  /// Limits of the static solve that follows the inputs.
  fem::StaticSettings inputs{.max_newton_iterations = 20, .max_load_steps = 6};
  /// Limits of the static solve of a continuation step. Larger: fewer and longer steps, but a
  /// failed one costs more before it is shortened.
  fem::StaticSettings continuation{
      .max_newton_iterations = 10, .max_full_steps = 8, .max_load_steps = 1};
  /// Damping of a continuation step after the first failure, and its growth with each further one.
  double least_damping = 1e-6;
  double damping_growth = 30.0;
  /// Failures in a row before the fit gives up.
  int most_failures = 8;
  /// Share of the weighted residual that a continuation step must take away, else it is the last.
  /// Smaller: more steps where the model is unstable near the rows, for nothing.
  double least_gain = 0.01;
};
constexpr ForceNewtonTuning kForceNewtonTuning;

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

ForceNewton::ForceNewton(robot::RobotModel& model, const Config& config)
    : model_(model),
      config_(config),
      compliance_(model.linearisation(), MarkerRows(model)),
      input_solver_(model.linearisation(), kForceNewtonTuning.inputs),
      continuation_solver_(model.linearisation(), kForceNewtonTuning.continuation),
      qp_(static_cast<int>(3 * model.body().markers.size()), model.traits()),
      weight_N_(Eigen::VectorXd::Zero(model.elastic_body().rest_m().size())),
      external_force_N_(weight_N_),
      nodal_(weight_N_),
      gradient_(weight_N_),
      cable_gradient_(weight_N_),
      effector_motion_(ToIndex(3 * model.body().markers.size())),
      cable_motion_(model.ActuatorCount()),
      responses_(model.linearisation().Size(), 1) {
  fit_.residual_m = Eigen::VectorXd::Zero(effector_motion_.size());
  SetSites({});
}

void ForceNewton::KeepFactor(bool keep) {
  keep_factor_ = keep;
  if (keep) model_.linearisation().KeepSinglePrecision();
}

void ForceNewton::SetRows(std::vector<robot::ObservationRow> rows) {
  const auto count = ToIndex(rows.size());
  compliance_.SetEffectors(std::move(rows));
  effector_motion_.resize(count);
  fit_.residual_m = Eigen::VectorXd::Zero(count);
}

void ForceNewton::SetSites(const std::vector<FitSite>& sites) {
  qp_.SetSites(sites);
  compliance_.SetForces(Directions(sites));
  const auto forces = ToIndex(3 * sites.size());
  fit_.covariance_N2 = Eigen::MatrixXd::Zero(forces, forces);
  fit_.unfitted_error = fem::QpMatrix::Zero(forces, 0);
  fit_.unfitted_sites.clear();
  fit_.modulus_sensitivity_N = Eigen::VectorXd::Zero(forces);
  if (forces != from_.lambda_f_N.size() || from_.x_m.size() == 0) {
    for (FitVariables* variables : {&from_, &step_, &correction_}) {
      variables->x_m = weight_N_;
      variables->lambda_a_N = qp_.lambda_a_N();
      variables->lambda_f_N = qp_.lambda_f_N();
    }
    accelerator_.SetUp(weight_N_.size(), model_.ActuatorCount(), forces);
  }
  last_good_.valid = false;
  factor_.columns_current = false;
  factor_.evaluated.valid = false;
}

const ForceFit& ForceNewton::Fit(const RowTargets& targets,
                                 const std::vector<robot::ActuatorCommand>& cables,
                                 ModelState* state, const fem::TimeBudget& budget) {
  frame_ = {.targets = &targets, .cables = &cables, .budget = &budget, .state = state};
  fit_.iterations = fit_.chord_steps = fit_.continuation_steps = 0;
  UpdateWeight();
  qp_.IncludeAllDirections();
  start_ = *state;
  fit_.status = FitWithContinuation();
  if (fit_.status.ok()) fit_.status = Conclude();
  if (Diverged(fit_.status)) *state = start_;
  factor_.evaluated = *state;
  factor_.evaluated.valid = fit_.status.ok();
  fit_.observability = qp_.observable().observability();
  fit_.unknowns = qp_.observable().unknowns();
  return fit_;
}

/// Newton's method with a frozen factor where one is kept. Where it diverges, exact steps from the
/// start: steps with the factor of another state may lead to where exact ones do not converge.
/// Where these diverge, too, and continuation steps are allowed, the inputs are followed under the
/// forces of the start: inputs and forces that both change far from an equilibrium lead astray.
/// After that continuation steps, each followed by exact steps.
Status ForceNewton::FitWithContinuation() {
  Status status = RunNewton(/*exact_only=*/false);
  if (Diverged(status) && fit_.chord_steps > 0) {
    *frame_.state = start_;
    status = RunNewton(/*exact_only=*/true);
  }
  if (Diverged(status) && !start_.balanced && last_good_.valid) start_ = last_good_;
  if (Diverged(status) && most_continuation_steps_ > 0) {
    *frame_.state = start_;
    const bool balanced = Balance(start_.lambda_f_N, &input_solver_, frame_.state).ok();
    const bool moved = balanced && frame_.state->x_m != start_.x_m;
    if (balanced) start_ = *frame_.state;
    if (moved) status = RunNewton(/*exact_only=*/true);
  }
  Continuation continuation;
  while (Diverged(status) && continuation.gains &&
         fit_.continuation_steps < most_continuation_steps_) {
    *frame_.state = start_;
    ++fit_.continuation_steps;
    if (Status moved = ContinueAlongEquilibria(&continuation); !moved.ok()) return moved;
    start_ = *frame_.state;
    status = RunNewton(/*exact_only=*/true);
  }
  return status;
}

Status ForceNewton::RunNewton(bool exact_only) {
  const bool keep_factor =
      keep_factor_ && !exact_only && factor_.excess_work < kFactorWork + kColumnsWork;
  const fem::FrameOutcome outcome = fem::SolveNewton(
      *this,
      {.relative_tolerance = config_.frame_tolerance,
       .max_exact_steps = std::max(1, config_.max_iterations - fit_.iterations),
       .keep_factor = keep_factor,
       .exact_step_cost_s = counts_work_ && !exact_only ? kFactorWork + kColumnsWork : 0.0},
      *frame_.budget);
  fit_.iterations += outcome.exact_steps;
  fit_.chord_steps += outcome.chord_steps;
  // Every frame needs one step; those beyond it would have been saved by a new factor.
  if (outcome.exact_steps == 0) factor_.excess_work += std::max(0, outcome.chord_steps - 1);
  fit_.error = outcome.error;
  frame_.state->balanced = outcome.converged();
  return outcome.status;
}

Status ForceNewton::PrepareExactStep() {
  const ModelState& state = *frame_.state;
  Status status = Linearise(state, /*allow_shift=*/false);
  if (!status.ok()) return status;
  status = SolveInObservableDirections(state);
  if (status.ok()) factor_.tangent_error = Error(state);
  return status;
}

/// With the factor of an earlier frame, the residual is of this state and W of the factor's state.
Status ForceNewton::PrepareFrozenFactorStep() {
  accelerator_.BeginFit();
  if (!factor_.known) return {};
  const ModelState& state = *frame_.state;
  if (!IsEvaluated(state)) {
    UpdateExternalForce(state.lambda_f_N);
    Status evaluated =
        model_.linearisation().UpdateResidual(state.x_m, state.lambda_a_N, external_force_N_);
    if (!evaluated.ok()) return evaluated;
    if (factor_.columns_current) {
      compliance_.ComputeChord(state.x_m, model_.actuator_rest_m(), state.lambda_a_N,
                               state.lambda_f_N);
      work_ += 1.0;
    } else {
      compliance_.Compute(state.x_m, model_.actuator_rest_m(), state.lambda_a_N, state.lambda_f_N);
      factor_.columns_current = true;
      work_ += kColumnsWork;
    }
  }
  compliance_.Observe(state.x_m, model_.actuator_rest_m());
  const Status status = SolveInObservableDirections(state);
  if (status.ok()) frame_.start_error = Error(state);
  return status;
}

bool ForceNewton::IsEvaluated(const ModelState& state) const {
  return factor_.evaluated.valid && factor_.columns_current &&
         factor_.evaluated.lambda_f_N == state.lambda_f_N &&
         factor_.evaluated.lambda_a_N == state.lambda_a_N && factor_.evaluated.x_m == state.x_m;
}

Status ForceNewton::SolveInObservableDirections(const ModelState& state) {
  qp_.Start(*frame_.cables, state.lambda_a_N);
  Status status = SolveQp(state);
  if (status.ok() && !frame_.observability_known) {
    qp_.KeepObservable(*frame_.targets, config_.unobservable_sigma_N);
    frame_.observability_known = true;
    status = SolveQp(state);
  }
  return status;
}

/// About the last linearisation, whose state is `state`.
Status ForceNewton::SolveQp(const ModelState& state, double damping) {
  return qp_.Solve(compliance_, *frame_.targets, *frame_.cables, state.lambda_f_N, damping);
}

Status ForceNewton::Try(double length, bool last) {
  const ModelState& state = *frame_.state;
  const double share = StepFraction(state);
  trial_.was_cut = share < 1.0;
  length *= share;
  trial_.state.x_m = state.x_m;
  compliance_.UpdateConfiguration(qp_.lambda_a_N(), qp_.lambda_f_N(), length, &trial_.state.x_m);
  trial_.state.lambda_a_N = state.lambda_a_N + length * (qp_.lambda_a_N() - state.lambda_a_N);
  trial_.state.lambda_f_N = state.lambda_f_N + length * (qp_.lambda_f_N() - state.lambda_f_N);
  if (keep_factor_ && length == 1.0) Accelerate();
  UpdateExternalForce(trial_.state.lambda_f_N);
  Status status = model_.linearisation().UpdateResidual(trial_.state.x_m, trial_.state.lambda_a_N,
                                                        external_force_N_);
  if (!status.ok()) return status;
  // The change of forces in the next step costs a substitution: the cheap errors come first.
  trial_.error = EquilibriumError(trial_.state);
  if (last && trial_.error > config_.frame_tolerance) return status;
  work_ += 1.0;
  compliance_.ComputeChord(trial_.state.x_m, model_.actuator_rest_m(), trial_.state.lambda_a_N,
                           trial_.state.lambda_f_N);
  status = SolveQp(trial_.state);
  if (!status.ok()) return status;
  trial_.error = Error(trial_.state);
  // The age of a kept factor says little about its error.
  if (!keep_factor_) {
    trial_.error =
        std::max(trial_.error, kForceNewtonTuning.tangent_error_weight * factor_.tangent_error);
  }
  return status;
}

/// Adds to the trial what the last steps with this factor say of the factor's error.
void ForceNewton::Accelerate() {
  const ModelState& state = *frame_.state;
  step_.x_m = trial_.state.x_m - state.x_m;
  step_.lambda_a_N = trial_.state.lambda_a_N - state.lambda_a_N;
  step_.lambda_f_N = trial_.state.lambda_f_N - state.lambda_f_N;
  from_.x_m = state.x_m;
  from_.lambda_a_N = state.lambda_a_N;
  from_.lambda_f_N = state.lambda_f_N;
  if (!accelerator_.Correct(from_, step_, &correction_)) return;
  trial_.state.x_m += correction_.x_m;
  trial_.state.lambda_a_N += correction_.lambda_a_N;
  trial_.state.lambda_f_N += correction_.lambda_f_N;
}

void ForceNewton::AcceptTrial() {
  frame_.state->x_m.swap(trial_.state.x_m);
  frame_.state->lambda_a_N.swap(trial_.state.lambda_a_N);
  frame_.state->lambda_f_N.swap(trial_.state.lambda_f_N);
}

/// `state`: the last one at which linearisation and QP were evaluated.
double ForceNewton::Error(const ModelState& state) const {
  return std::max(EquilibriumError(state), ForceChangeError(state));
}

/// `state`: the last one at which the linearisation was evaluated.
double ForceNewton::EquilibriumError(const ModelState& state) const {
  const fem::Linearisation& linearisation = model_.linearisation();
  const double residual_N = linearisation.residual_N().norm();
  double error = CableError(state);
  if (residual_N > fem::RoundingForce_N(linearisation, state.x_m)) {
    const double scale_N = std::max(
        {linearisation.internal_force_norm_N(), weight_N_.norm(), state.lambda_f_N.norm(), 1e-9});
    error = std::max(error, residual_N / scale_N);
  }
  return error;
}

/// Length by which a taut cable misses its displacement, or by which a slack one is too long, over
/// its rest length; the same of chambers; the largest of all.
double ForceNewton::CableError(const ModelState& state) const {
  double error = 0.0;
  for (int c = 0; c < model_.ActuatorCount(); ++c) {
    const robot::ActuatorCommand& command = (*frame_.cables)[At(c)];
    if (command.kind != Kind::kDisplacement) continue;
    const robot::Actuator& actuator = model_.actuator(c);
    const double missing_m = command.value - actuator.Displacement_m(state.x_m);
    const bool taut = state.lambda_a_N[c] > model_.traits(c).least_force_N;
    error = std::max(error,
                     (taut ? std::abs(missing_m) : missing_m) / std::abs(actuator.rest_value_m()));
  }
  return error;
}

/// Largest change of a force in the QP's solution, over the largest contact force, or 1 N.
double ForceNewton::ForceChangeError(const ModelState& state) const {
  const double change = std::max((qp_.lambda_f_N() - state.lambda_f_N).lpNorm<Eigen::Infinity>(),
                                 (qp_.lambda_a_N() - state.lambda_a_N).lpNorm<Eigen::Infinity>());
  return change / std::max(1.0, qp_.lambda_f_N().lpNorm<Eigen::Infinity>());
}

/// Fraction of the QP's step that LimitForceStep admits.
double ForceNewton::StepFraction(const ModelState& state) const {
  const double change_N = (qp_.lambda_f_N() - state.lambda_f_N).lpNorm<Eigen::Infinity>();
  return longest_step_N_ > 0.0 && change_N > longest_step_N_ ? longest_step_N_ / change_N : 1.0;
}

/// One continuation step: the QP's change of forces, as little damped as leads to an equilibrium in
/// which the rows' residual has not risen.
Status ForceNewton::ContinueAlongEquilibria(Continuation* continuation) {
  const ForceNewtonTuning& tuning = kForceNewtonTuning;
  ModelState& state = *frame_.state;
  Status status = Linearise(state, /*allow_shift=*/true);
  if (!status.ok()) return status;
  ++fit_.iterations;
  // The residual before is comparable only where the state before was an equilibrium.
  const double before = state.balanced ? ChiSquared(*frame_.targets, state, &fit_.residual_m)
                                       : std::numeric_limits<double>::infinity();
  double& damping = continuation->damping;
  damping = damping > tuning.least_damping ? damping / tuning.damping_growth : 0.0;
  for (int failures = 0; failures < tuning.most_failures; ++failures) {
    qp_.Start(*frame_.cables, state.lambda_a_N);
    status = SolveQp(state, damping);
    if (!status.ok()) return status;
    ModelState moved = state;
    status = Balance(qp_.lambda_f_N(), &continuation_solver_, &moved);
    if (status.code() == StatusCode::kBudgetReached) return status;
    const double after = ChiSquared(*frame_.targets, moved, &fit_.residual_m);
    if (status.ok() && after <= before) {
      state = std::move(moved);
      continuation->gains = after <= (1.0 - tuning.least_gain) * before;
      return Status::Ok();
    }
    damping = std::max(tuning.least_damping, tuning.damping_growth * damping);
  }
  return {StatusCode::kNotConverged, {}};
}

/// Brings `state` into equilibrium with the frame's inputs and these contact forces. It stays as it
/// was where that fails.
Status ForceNewton::Balance(const Eigen::VectorXd& lambda_f_N, fem::StaticSolver* solver,
                            ModelState* state) {
  fem::LoadState loads = model_.Loads(*frame_.cables, {});
  fem::StaticState body{state->x_m, state->lambda_a_N, loads};
  UpdateExternalForce(state->lambda_f_N);
  body.loads.external_force_N = external_force_N_;
  UpdateExternalForce(lambda_f_N);
  loads.external_force_N = external_force_N_;
  const Status status = solver->Solve(loads, &body, *frame_.budget).status;
  if (!status.ok()) return status;
  state->x_m = body.x_m;
  state->lambda_a_N = body.multipliers_N;
  state->lambda_f_N = lambda_f_N;
  state->balanced = true;
  return status;
}

Status ForceNewton::Linearise(const ModelState& state, bool allow_shift) {
  UpdateExternalForce(state.lambda_f_N);
  factor_.known = false;
  factor_.excess_work = 0.0;
  accelerator_.Forget();
  Status status =
      model_.linearisation().Update(state.x_m, state.lambda_a_N, external_force_N_, allow_shift);
  if (!status.ok()) return status;
  factor_.known = !model_.linearisation().shifted();
  factor_.columns_current = true;
  compliance_.Compute(state.x_m, model_.actuator_rest_m(), state.lambda_a_N, state.lambda_f_N);
  work_ += kFactorWork + kColumnsWork;
  return status;
}

void ForceNewton::UpdateWeight() {
  weight_N_.setZero();
  model_.AddWeight(weight_N_);
}

void ForceNewton::UpdateExternalForce(const Eigen::VectorXd& lambda_f_N) {
  external_force_N_ = weight_N_;
  for (size_t f = 0; f < compliance_.forces().size(); ++f) {
    compliance_.forces()[f].AddForce(lambda_f_N[ToIndex(f)], external_force_N_);
  }
}

double ForceNewton::ChiSquared(const RowTargets& targets, const ModelState& state,
                               Eigen::VectorXd* residual_m) const {
  double sum = 0.0;
  for (size_t r = 0; r < rows().size(); ++r) {
    const auto row = ToIndex(r);
    const bool seen = targets.weight[row] > 0.0;
    const double residual = seen ? targets.value_m[row] - rows()[r].Value(state.x_m) : 0.0;
    (*residual_m)[row] = residual;
    sum += targets.weight[row] * residual * residual;
  }
  return sum;
}

/// Residual, covariance and sensitivity to the modulus of a converged fit.
Status ForceNewton::Conclude() {
  const RowTargets& targets = *frame_.targets;
  const ModelState& state = *frame_.state;
  fit_.chi_squared = ChiSquared(targets, state, &fit_.residual_m);
  if (Status status = CheckTensions(state); !status.ok()) return status;
  const fem::QpMatrix covariance_N2 = qp_.Covariance_N2(targets);
  fit_.covariance_N2 = covariance_N2;
  fit_.unfitted_sites = qp_.observable().unfitted_sites();
  fit_.unfitted_error = qp_.UnfittedError(targets, covariance_N2);
  if (tell_modulus_sensitivity_) ModulusSensitivity(targets, state);
  last_good_ = state;
  last_good_.valid = true;
  return Status::Ok();
}

Status ForceNewton::CheckTensions(const ModelState& state) const {
  for (int c = 0; c < model_.ActuatorCount(); ++c) {
    const double tension_N = state.lambda_a_N[c];
    const robot::ActuatorTraits& limits = model_.traits(c);
    if (tension_N < limits.least_force_N - most_push_N_) {
      return {StatusCode::kNotConverged,
              limits.Title() +
                  (limits.IsChamber() ? " would be below a vacuum" : " would have to push")};
    }
    if (tension_N > limits.most_force_N) {
      return {
          StatusCode::kTensionLimit,
          limits.Title() +
              (limits.IsChamber() ? " would need a pressure of " : " would have to pull with ") +
              FormatNumber(limits.ReportedForce(tension_N)) + " " + limits.force_unit() +
              ", more than its " + (limits.IsChamber() ? "max_pressure_Pa" : "max_tension_N")};
    }
  }
  return Status::Ok();
}

/// Stiffer material needs larger forces for the same shape: the forces of the cells grow with ln E,
/// those of fibres do not, and the fit with them by dlambda_f/dlnE = -(G' S^-1 G)^-1 G' S^-1
/// de/dlnE.
void ForceNewton::ModulusSensitivity(const RowTargets& targets, const ModelState& state) {
  nodal_.setZero();
  model_.elastic_body().AddForcesOfCells(state.x_m, nodal_);
  nodal_ *= -1.0;
  RespondTo(nodal_, state.x_m, &response_motion_m_);
  fit_.modulus_sensitivity_N.noalias() =
      -fit_.covariance_N2 * qp_.Projection(targets, response_motion_m_.col(0));
}

void ForceNewton::RespondTo(const Eigen::Ref<const Eigen::MatrixXd>& forces_N,
                            const Eigen::VectorXd& x_m, Eigen::MatrixXd* row_motions_m) {
  const fem::StiffnessMatrix& matrix = model_.linearisation().matrix();
  responses_.resize(matrix.Size(), forces_N.cols());
  for (Eigen::Index k = 0; k < forces_N.cols(); ++k) {
    matrix.Reduce(forces_N.col(k), responses_.col(k));
  }
  model_.linearisation().SolveSingle(responses_);
  work_ += kColumnsWork;
  row_motions_m->resize(ToIndex(rows().size()), forces_N.cols());
  for (Eigen::Index k = 0; k < forces_N.cols(); ++k) {
    gradient_.setZero();
    matrix.AddExpanded(responses_.col(k), 1.0, gradient_);
    for (size_t r = 0; r < rows().size(); ++r) {
      effector_motion_[ToIndex(r)] = rows()[r].Value(gradient_);
    }
    for (int c = 0; c < model_.ActuatorCount(); ++c) {
      cable_gradient_.setZero();
      model_.actuator(c).AddGradient(x_m, -1.0, cable_gradient_);
      cable_motion_[c] = cable_gradient_.dot(gradient_);
    }
    qp_.response().HoldTautCables(compliance_, cable_motion_, &effector_motion_);
    row_motions_m->col(k) = effector_motion_;
  }
}

/// By reciprocity all candidates together cost one solve for each row.
Status ForceNewton::Screen(const RowTargets& targets,
                           const std::vector<robot::ActuatorCommand>& cables,
                           const ModelState& state, const std::vector<FitSite>& candidates,
                           std::vector<ScreenedSite>* screened) {
  const std::vector<FitSite> sites = qp_.sites();
  screened->clear();
  UpdateWeight();
  if (Status status = Linearise(state, /*allow_shift=*/true); !status.ok()) return status;
  compliance_.PrepareReciprocity();
  ModelState extended = state;
  extended.lambda_f_N.conservativeResizeLike(Eigen::VectorXd::Zero(3 * (SiteCount() + 1)));
  for (const FitSite& candidate : candidates) {
    std::vector<FitSite> with_candidate = sites;
    with_candidate.push_back(candidate);
    SetSites(with_candidate);
    compliance_.ObserveByReciprocity();
    qp_.Start(cables, state.lambda_a_N);
    if (!qp_.Solve(compliance_, targets, cables, extended.lambda_f_N).ok()) {
      screened->push_back({.chi_squared = std::numeric_limits<double>::infinity()});
      continue;
    }
    screened->push_back({qp_.ChiSquared(targets), qp_.lambda_f_N().tail<3>()});
  }
  SetSites(sites);
  return Status::Ok();
}

}  // namespace palpate::force_estimation
