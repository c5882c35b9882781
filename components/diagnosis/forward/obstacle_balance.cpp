// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/forward/obstacle_balance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "components/diagnosis/forward/complementarity.hpp"
#include "libs/core/index.hpp"
#include "libs/robot/sensitivity/parameters.hpp"

namespace palpate::diagnosis {

namespace {

constexpr int kMostBalanceRounds = 40;
constexpr double kBalanced_m = 1e-9;  ///< between where nodes are and where their forces have them
constexpr double kNear_m = 3e-4;      ///< nodes that may come to touch as others are pushed back
constexpr double kSlow = 0.3;         ///< share of the error left by a round
constexpr double kStride_m = 3e-3;    ///< by which nodes are pushed out in one round
constexpr double kFar_m = 5e-4;       ///< a step that must have the tangent of where it begins
constexpr double kFine_m = 1e-6;      ///< steps that are cheaper than another tangent
constexpr double kShrinks = 0.5;  ///< share of a step that the next may have with the same tangent

void HoldFixed(const fem::FixedDirections& fixed, const Eigen::VectorXd& position_m,
               Eigen::VectorXd* x_m) {
  const auto is_fixed = fixed.reshaped().array();
  *x_m = is_fixed.select(position_m, *x_m);
}

}  // namespace

ObstacleBalance::ObstacleBalance(const Obstacle& obstacle, robot::RobotModel* model)
    : obstacle_(obstacle), model_(*model), sensitivity_(*model), step_(model->linearisation()) {
  const auto nodes = std::ssize(obstacle.surface->nodes);
  depth_m_ = force_N_ = Eigen::VectorXd::Zero(nodes);
}

Status ObstacleBalance::Solve(const std::vector<robot::ActuatorCommand>& cables,
                              const fem::LoadState& loads, fem::StaticState* state,
                              Eigen::VectorXd* force_N) {
  const auto nodes = std::ssize(obstacle_.surface->nodes);
  force_N_ = force_N->size() > 0 ? *force_N : Eigen::VectorXd::Zero(nodes);
  state->loads.external_force_N += NodalForces_N(obstacle_, force_N_, state->x_m.size());
  fem::LoadState free = loads;
  free.commands.back() = {};
  const fem::StaticState start = *state;
  const Eigen::VectorXd started_with_N = force_N_;
  Status status = StepTogether(cables, loads.external_force_N, &free, state);
  if (!status.ok()) {
    *state = start;
    force_N_ = started_with_N;
    status = BalanceInTurn(cables, loads.external_force_N, &free, state);
  }
  state->loads = loads;
  state->multipliers_N.tail<1>().setConstant(ObstacleContact::kThere_N);
  *force_N = force_N_.maxCoeff() > 0.0 ? force_N_ : Eigen::VectorXd();
  return status;
}

/// A step of the body towards balance and new forces of the obstacle, in turn: most of what each
/// does to the other is foreseen, so that both settle as fast as one.
Status ObstacleBalance::StepTogether(const std::vector<robot::ActuatorCommand>& cables,
                                     const Eigen::VectorXd& others_N, fem::LoadState* loads,
                                     fem::StaticState* state) {
  constexpr int kMostSteps = 60;
  constexpr int kMostTangents = 20;
  fem::Linearisation& linearisation = model_.linearisation();
  HoldFixed(linearisation.fixed(), loads->fixed_position_m, &state->x_m);
  fem::EquilibriumStep::ImposeMultipliers(*loads, &state->multipliers_N);
  double before_m = std::numeric_limits<double>::infinity();
  bool renew = !step_.HasTangentFor(*loads);
  int tangents = 0;
  for (int k = 0; k < kMostSteps && tangents < kMostTangents; ++k) {
    loads->external_force_N = others_N + NodalForces_N(obstacle_, force_N_, state->x_m.size());
    Status stepped = Step(*loads, *state, renew);
    if (stepped.ok() && !renew && step_.dx().cwiseAbs().maxCoeff() > kFar_m) {
      renew = true;
      stepped = Step(*loads, *state, renew);
    }
    if (!stepped.ok()) return stepped;
    tangents += renew;
    step_.Apply(1.0, state->x_m, state->multipliers_N, &next_.x_m, &next_.multipliers_N);
    const double step_m = (next_.x_m - state->x_m).cwiseAbs().maxCoeff();
    std::swap(state->x_m, next_.x_m);
    std::swap(state->multipliers_N, next_.multipliers_N);
    const double error_m = UpdateDepths(*state);
    if (step_m < kBalanced_m && error_m < kBalanced_m) {
      return fem::CheckLargestMultipliers(linearisation, *loads, state->x_m, state->multipliers_N,
                                          kBalanced_m);
    }
    renew = step_m > (step_m > kFine_m ? kShrinks : 1.0) * before_m;
    before_m = renew ? std::numeric_limits<double>::infinity() : step_m;
    if (error_m < kBalanced_m) continue;
    if (compliance_of_ != linearisation.factor_count() || !CoversWhatTouches()) {
      const Status known = UpdateCompliance(cables, *state);
      if (!known.ok()) return known;
    }
    PressAgain();
  }
  return {StatusCode::kNotConverged, "contact with the obstacle did not converge"};
}

/// With a new tangent, or the one that is there.
Status ObstacleBalance::Step(const fem::LoadState& loads, const fem::StaticState& state,
                             bool renew) {
  if (renew) return step_.Compute(loads, state.x_m, state.multipliers_N, /*allow_shift=*/false);
  const Status known =
      model_.linearisation().UpdateResidual(state.x_m, state.multipliers_N, loads.external_force_N);
  return known.ok() ? step_.ComputeChord(loads, state.x_m, state.multipliers_N) : known;
}

/// The body in balance under what the obstacle presses with, and what it does then, in turn: slow,
/// and for steps that StepTogether does not find its way with.
Status ObstacleBalance::BalanceInTurn(const std::vector<robot::ActuatorCommand>& cables,
                                      const Eigen::VectorXd& others_N, fem::LoadState* loads,
                                      fem::StaticState* state) {
  double before_m = std::numeric_limits<double>::infinity();
  for (int round = 0; round < kMostBalanceRounds; ++round) {
    loads->external_force_N = others_N + NodalForces_N(obstacle_, force_N_, state->x_m.size());
    const Status balanced = model_.static_solver().Solve(*loads, state).status;
    if (!balanced.ok()) return balanced;
    const double error_m = UpdateDepths(*state);
    if (error_m < kBalanced_m) return Status::Ok();
    if (!CoversWhatTouches() || error_m > kSlow * before_m) {
      const Status known = UpdateCompliance(cables, *state);
      if (!known.ok()) return known;
    }
    before_m = error_m;
    PressAgain();
  }
  return {StatusCode::kNotConverged, "contact with the obstacle did not converge"};
}

/// By how much the nodes are not where what presses on them would have them, m.
double ObstacleBalance::UpdateDepths(const fem::StaticState& state) {
  const ObstacleSurface& surface = *obstacle_.surface;
  double error_m = 0.0;
  for (Eigen::Index k = 0; k < depth_m_.size(); ++k) {
    depth_m_[k] = obstacle_.Depth_m(surface.nodes[At(k)], state.x_m);
    const double missed_m = depth_m_[k] - force_N_[k] / surface.stiffness_N_m;
    error_m = std::max(error_m, force_N_[k] > 0.0 ? std::abs(missed_m) : missed_m);
  }
  return error_m;
}

/// Whether the compliance is known of all nodes that touch or go too deep.
bool ObstacleBalance::CoversWhatTouches() const {
  auto next = active_.begin();
  for (int k = 0; k < std::ssize(depth_m_); ++k) {
    if (next != active_.end() && *next == k) {
      ++next;
    } else if (force_N_[k] > 0.0 || depth_m_[k] > 0.0) {
      return false;
    }
  }
  return true;
}

/// How the nodes that touch, or may come to, yield to each other's forces.
Status ObstacleBalance::UpdateCompliance(const std::vector<robot::ActuatorCommand>& cables,
                                         const fem::StaticState& state) {
  active_.clear();
  std::vector<robot::ParameterPtr> pushes;
  std::vector<fem::InterpolationWeights> points;
  for (int k = 0; k < std::ssize(depth_m_); ++k) {
    if (!(force_N_[k] > 0.0 || depth_m_[k] > -kNear_m)) continue;
    const int node = obstacle_.surface->nodes[At(k)];
    Eigen::VectorXd push = Eigen::VectorXd::Zero(state.x_m.size());
    push.segment<3>(3 * node) = obstacle_.normal;
    active_.push_back(k);
    pushes.push_back(robot::NodalForce(std::move(push)));
    points.push_back({{node}, {1.0}});
  }
  const Status known = sensitivity_.Compute(cables, state, pushes, robot::Factor::kPresent);
  if (!known.ok()) return known;
  compliance_of_ = model_.linearisation().factor_count();
  Eigen::MatrixXd motions_m;
  sensitivity_.PointMotions(points, &motions_m);
  const auto count = std::ssize(points);
  Eigen::MatrixXd along(count, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    along.row(i) = obstacle_.normal.transpose() * motions_m.middleRows<3>(3 * i);
  }
  compliance_m_N_ = 0.5 * (along + along.transpose());
  return known;
}

/// To forces under which, to first order, every node is out of the obstacle or as deep as its force
/// has it; of an obstacle that is met deep inside of the body, of one a stride farther in than now.
void ObstacleBalance::PressAgain() {
  const Eigen::VectorXd pressed_N = force_N_(active_);
  Eigen::MatrixXd M = compliance_m_N_;
  M.diagonal().array() += 1.0 / obstacle_.surface->stiffness_N_m;
  const Eigen::VectorXd depth_m = depth_m_(active_);
  const double later_m = std::max(0.0, depth_m.maxCoeff() - kStride_m);
  const Eigen::VectorXd q = later_m - (depth_m + compliance_m_N_ * pressed_N).array();
  force_N_(active_) = SolveComplementarity(M, q, pressed_N);
}

}  // namespace palpate::diagnosis
