// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/joint/body_shapes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "libs/core/index.hpp"
#include "libs/fem/static_solver.hpp"
#include "libs/robot/frame_tracker.hpp"

namespace palpate::calibration {

namespace {

struct BodyShapesTuning {
  /// Residual over the size of the forces at which the variables may move, too: before, stretched
  /// bodies determine wrong moduli; less costs Newton steps.
  double near = 1e-2;
  double balanced = 1e-9;             ///< the same of an equilibrium
  double shortest_step = 1.0 / 16.0;  ///< share of a step that inverts no element
};
constexpr BodyShapesTuning kShapesTuning;

}  // namespace

BodyShapes::BodyShapes(robot::RobotModel& model, const JointSetup& setup, int first_column)
    : setup_(setup),
      first_column_(first_column),
      team_(1 + static_cast<int>(setup.helpers.size())),
      kept_(setup.states.empty()
                ? std::vector<fem::StaticState>(setup.frames.size(), model.RestState())
                : setup.states),
      states_(kept_),
      kept_solved_(setup.frames.size()),
      solved_(setup.frames.size()),
      scales_(std::any_of(setup.unknowns.begin(), setup.unknowns.end(),
                          [](const UnknownPtr& one) { return one->ScalesTheRobot(); })) {
  workers_.push_back(std::make_unique<Worker>(model));
  for (const auto& helper : setup.helpers) workers_.push_back(std::make_unique<Worker>(*helper));
}

void BodyShapes::Keep() {
  kept_ = states_;
  kept_solved_ = solved_;
}

void BodyShapes::Return() { states_ = kept_; }

double BodyShapes::ValueOf(std::size_t unknown, const Eigen::VectorXd& variables) const {
  const GaussianPrior& prior = setup_.unknowns[unknown]->prior();
  const auto column = first_column_ + ToIndex(unknown);
  return prior.mean + ScaleOf(prior) * variables[column];
}

FrameInputs BodyShapes::InputsOf(int frame, const Eigen::VectorXd& variables) const {
  const CalibrationFrame& given = setup_.frames[At(frame)];
  FrameInputs inputs{.cables = given.cables,
                     .loads = given.loads,
                     .nominal_gravity_m_s2 = given.gravity_m_s2,
                     .gravity_m_s2 = given.gravity_m_s2};
  for (std::size_t u = 0; u < setup_.unknowns.size(); ++u) {
    setup_.unknowns[u]->ApplyToFrame(ValueOf(u, variables), frame, &inputs);
  }
  if (scales_) HoldLoadsAt(given.load_places, workers_.front()->model, &inputs);
  return inputs;
}

Status BodyShapes::ApplyToModels(const Eigen::VectorXd& variables) {
  for (std::size_t u = 0; u < setup_.unknowns.size(); ++u) {
    const double value = ValueOf(u, variables);
    for (const auto& worker : workers_) {
      Status status = setup_.unknowns[u]->ApplyToModel(value, &worker->model);
      if (!status.ok()) return status;
    }
  }
  return Status::Ok();
}

/// Status of the first frame that fails, in the order of the frames.
template <typename Work>
Status BodyShapes::OnEachFrame(const Work& work) {
  std::vector<Status> status(setup_.frames.size(), Status::Ok());
  const std::size_t step = workers_.size();
  team_.Run([&](int index) {
    const auto first = static_cast<std::size_t>(index);
    for (std::size_t f = first; f < status.size(); f += step) {
      status[f] = work(static_cast<int>(f), workers_[first].get());
    }
  });
  for (std::size_t f = 0; f < status.size(); ++f) {
    if (status[f].ok()) continue;
    return {status[f].code(), setup_.frames[f].name + ": " + status[f].message()};
  }
  return Status::Ok();
}

Status BodyShapes::Balance(const Eigen::VectorXd& variables, LeastSquaresPoint* point) {
  if (Status status = ApplyToModels(variables); !status.ok()) return status;
  return OnEachFrame([&](int frame, Worker* worker) {
    Status status = BalanceFrame(frame, variables, worker);
    if (status.ok()) CheckConditions(frame, *worker, point);
    return status;
  });
}

/// The frame's equilibrium, from the last kept one, and how it depends on the variables.
Status BodyShapes::BalanceFrame(int frame, const Eigen::VectorXd& variables, Worker* worker) {
  const auto f = static_cast<size_t>(frame);
  const FrameInputs inputs = InputsOf(frame, variables);
  const FrameInputs acting = ToModel(inputs);
  worker->model.SetGravity(acting.mass_factor * acting.gravity_m_s2);
  states_[f] = kept_[f];
  const SolvedState::Move move = kept_solved_[f].MoveTo(variables, &states_[f]);
  if (move == SolvedState::Move::kTiny && !HasCondition(frame)) {
    solved_[f] = kept_solved_[f];
    return Status::Ok();
  }
  const fem::StaticResult result = worker->model.Solve(acting.cables, acting.loads, &states_[f]);
  if (!result.status.ok()) return result.status;
  DescribeInfluences(frame, inputs, variables, worker);
  Status status = worker->sensitivity.Compute(acting.cables, states_[f], worker->parameters,
                                              robot::Factor::kPresent);
  if (status.ok()) {
    solved_[f].Keep(states_[f], variables, worker->column_of, worker->factor_of,
                    worker->sensitivity);
  }
  return status;
}

void BodyShapes::DescribeInfluences(int frame, const FrameInputs& inputs,
                                    const Eigen::VectorXd& variables, Worker* worker) const {
  worker->parameters.clear();
  worker->column_of.clear();
  worker->factor_of.clear();
  for (std::size_t u = 0; u < setup_.unknowns.size(); ++u) {
    const Unknown& unknown = *setup_.unknowns[u];
    for (Influence& influence :
         unknown.InfluencesOn(worker->model, ValueOf(u, variables), frame, inputs)) {
      worker->parameters.push_back(std::move(influence.parameter));
      worker->column_of.push_back(first_column_ + ToIndex(u));
      worker->factor_of.push_back(influence.per_value * ScaleOf(unknown.prior()));
    }
  }
}

Status BodyShapes::ComeNear(const Eigen::VectorXd& variables) {
  if (Status status = ApplyToModels(variables); !status.ok()) return status;
  return OnEachFrame([&](int frame, Worker* worker) {
    return IsGuessed(frame, variables) ? Status::Ok() : FollowFrame(frame, variables, worker);
  });
}

/// Whether an input of this frame has no prior.
bool BodyShapes::IsGuessed(int frame, const Eigen::VectorXd& variables) const {
  const FrameInputs inputs = InputsOf(frame, variables);
  for (std::size_t u = 0; u < setup_.unknowns.size(); ++u) {
    const Unknown& unknown = *setup_.unknowns[u];
    if (std::isfinite(unknown.prior().sigma)) continue;
    const robot::RobotModel& model = workers_.front()->model;
    if (!unknown.InfluencesOn(model, ValueOf(u, variables), frame, inputs).empty()) return true;
  }
  return false;
}

Status BodyShapes::FollowFrame(int frame, const Eigen::VectorXd& variables, Worker* worker) {
  const FrameInputs acting = ToModel(InputsOf(frame, variables));
  robot::RobotModel& model = worker->model;
  model.SetGravity(acting.mass_factor * acting.gravity_m_s2);
  Eigen::VectorXd weight_N = Eigen::VectorXd::Zero(model.elastic_body().rest_m().size());
  model.AddWeight(weight_N);
  robot::FrameTracker tracker(model, {.relative_tolerance = kShapesTuning.near});
  fem::StaticState& state = states_[At(frame)];
  tracker.Start(state);
  const fem::LoadState loads = model.Loads(acting.cables, acting.loads);
  const fem::FrameOutcome& outcome =
      tracker.Follow(acting.cables, loads.external_force_N - weight_N);
  if (outcome.converged()) state = tracker.state();
  return outcome.status;
}

Status BodyShapes::Linearise(const Eigen::VectorXd& variables) {
  if (Status status = ApplyToModels(variables); !status.ok()) return status;
  return OnEachFrame(
      [&](int frame, Worker* worker) { return LineariseFrame(frame, variables, worker); });
}

void BodyShapes::Load(const FrameInputs& acting, fem::StaticState* state, Worker* worker) {
  worker->model.SetGravity(acting.mass_factor * acting.gravity_m_s2);
  state->loads = worker->model.Loads(acting.cables, acting.loads);
  fem::EquilibriumStep::ImposeMultipliers(state->loads, &state->multipliers_N);
}

Status BodyShapes::LineariseFrame(int frame, const Eigen::VectorXd& variables, Worker* worker) {
  const auto f = static_cast<size_t>(frame);
  const FrameInputs inputs = InputsOf(frame, variables);
  const FrameInputs acting = ToModel(inputs);
  Load(acting, &states_[f], worker);
  const fem::StaticState& state = states_[f];
  Status status = worker->step.Compute(state.loads, state.x_m, state.multipliers_N,
                                       /*allow_shift=*/false);
  if (!status.ok()) return status;
  fem::StaticState led_to = state;
  worker->step.Apply(1.0, state.x_m, state.multipliers_N, &led_to.x_m, &led_to.multipliers_N);
  // Derivatives at the present shape, with the cables that are taut after the step.
  fem::StaticState about = state;
  about.multipliers_N = led_to.multipliers_N;
  DescribeInfluences(frame, inputs, variables, worker);
  status = worker->sensitivity.Compute(acting.cables, about, worker->parameters,
                                       robot::Factor::kPresent);
  if (status.ok()) {
    solved_[f].Keep(led_to, variables, worker->column_of, worker->factor_of, worker->sensitivity);
  }
  return status;
}

Status BodyShapes::LineariseKept(const Eigen::VectorXd& variables) {
  if (Status status = ApplyToModels(variables); !status.ok()) return status;
  return OnEachFrame(
      [&](int frame, Worker* worker) { return LineariseKeptFrame(frame, variables, worker); });
}

Status BodyShapes::LineariseKeptFrame(int frame, const Eigen::VectorXd& variables, Worker* worker) {
  const auto f = static_cast<size_t>(frame);
  Load(ToModel(InputsOf(frame, variables)), &states_[f], worker);
  const fem::StaticState& state = states_[f];
  Status status = worker->model.linearisation().UpdateResidual(state.x_m, state.multipliers_N,
                                                               state.loads.external_force_N);
  if (status.ok()) {
    status = worker->step.ComputeChord(state.loads, state.x_m, state.multipliers_N);
  }
  if (!status.ok()) return status;
  fem::StaticState led_to = state;
  worker->step.Apply(1.0, state.x_m, state.multipliers_N, &led_to.x_m, &led_to.multipliers_N);
  solved_[f].MoveBase(led_to, variables);
  return status;
}

double BodyShapes::StepTo(const Eigen::VectorXd& variables) {
  std::vector<double> furthest(states_.size(), 0.0);
  const Status always_ok = OnEachFrame([&](int frame, Worker* worker) {
    furthest[At(frame)] = StepFrame(frame, variables, worker);
    return Status::Ok();
  });
  if (!always_ok.ok()) return std::numeric_limits<double>::infinity();
  return *std::max_element(furthest.begin(), furthest.end());
}

double BodyShapes::StepFrame(int frame, const Eigen::VectorXd& variables, Worker* worker) {
  constexpr double kShortestStep = kShapesTuning.shortest_step;
  const auto f = static_cast<size_t>(frame);
  const fem::StaticState from = states_[f];
  fem::StaticState to = from;
  solved_[f].Extrapolate(variables, &to);
  for (double length = 1.0; length >= kShortestStep; length *= 0.5) {
    states_[f].x_m = from.x_m + length * (to.x_m - from.x_m);
    states_[f].multipliers_N =
        from.multipliers_N + length * (to.multipliers_N - from.multipliers_N);
    double min_J = 0.0;
    const double energy_J = worker->model.elastic_body().Energy(states_[f].x_m, &min_J);
    if (!(min_J > 0.0) || !std::isfinite(energy_J)) continue;
    if (length < 1.0) break;
    solved_[f].MoveBase(to, variables);
    return (to.x_m - from.x_m).lpNorm<Eigen::Infinity>() / ExtentOf(from.x_m);
  }
  return std::numeric_limits<double>::infinity();
}

bool BodyShapes::AreBalanced(const Eigen::VectorXd& variables) {
  if (!ApplyToModels(variables).ok()) return false;
  return OnEachFrame(
             [&](int frame, Worker* worker) { return CheckFrame(frame, variables, worker); })
      .ok();
}

Status BodyShapes::CheckFrame(int frame, const Eigen::VectorXd& variables, Worker* worker) {
  constexpr double kMostMissed_m = fem::StaticSettings().constraint_tolerance_m;
  fem::StaticState& state = states_[At(frame)];
  Load(ToModel(InputsOf(frame, variables)), &state, worker);
  fem::Linearisation& linearisation = worker->model.linearisation();
  if (Status status = linearisation.UpdateResidual(state.x_m, state.multipliers_N,
                                                   state.loads.external_force_N);
      !status.ok()) {
    return status;
  }
  const double residual_N = linearisation.residual_N().norm();
  const double scale_N = fem::ForceScale_N(linearisation, state.loads, state.multipliers_N);
  const double missed_m =
      fem::ConstraintError_m(linearisation, state.loads, state.x_m, state.multipliers_N);
  const bool balanced = residual_N <= std::max(kShapesTuning.balanced * scale_N,
                                               fem::RoundingForce_N(linearisation, state.x_m)) &&
                        missed_m <= kMostMissed_m;
  if (!balanced) return {StatusCode::kNotConverged, "not in equilibrium"};
  for (const fem::ConstraintCommand& command : state.loads.commands) {
    const bool imposed = command.mode == fem::ConstraintCommand::Mode::kMultiplier;
    if (imposed && !(command.value >= 0.0 && command.value <= command.max_multiplier_N)) {
      return {StatusCode::kTensionLimit, "a tension beyond its limits"};
    }
  }
  return fem::CheckLargestMultipliers(linearisation, state.loads, state.x_m, state.multipliers_N,
                                      kMostMissed_m);
}

bool BodyShapes::HasCondition(int frame) const {
  return std::any_of(setup_.conditions.begin(), setup_.conditions.end(),
                     [&](const ConditionPtr& condition) { return condition->frame() == frame; });
}

void BodyShapes::CheckConditions(int frame, const Worker& worker, LeastSquaresPoint* point) const {
  for (std::size_t c = 0; c < setup_.conditions.size(); ++c) {
    const Condition& condition = *setup_.conditions[c];
    if (condition.frame() != frame) continue;
    const auto row = ToIndex(c);
    point->constraint[row] = condition.Value(worker.model, states_[At(frame)]);
    const Eigen::RowVectorXd derivative = condition.Derivative(worker.sensitivity);
    for (std::size_t p = 0; p < worker.column_of.size(); ++p) {
      point->constraint_jacobian(row, worker.column_of[p]) +=
          worker.factor_of[p] * derivative[ToIndex(p)];
    }
  }
}

}  // namespace palpate::calibration
