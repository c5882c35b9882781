// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/virtual_robot/bench.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "components/virtual_robot/bench_contacts.hpp"
#include "libs/core/error.hpp"

namespace palpate::virtual_robot {

namespace {

constexpr int kMostHalvings = 6;

/// From the first recording's begin to the last one's end.
double Duration_s(const scenario::Scenario& scenario) {
  double duration_s = 0.0;
  for (const scenario::RecordingPlan& plan : scenario.recordings) duration_s += plan.duration_s;
  const size_t rests = scenario.recordings.empty() ? 0 : scenario.recordings.size() - 1;
  duration_s += static_cast<double>(rests) * scenario.rest_between_s;
  return duration_s > 0.0 ? duration_s : 1.0;
}

const Effects& Checked(const scenario::Scenario& scenario, const Effects& effects) {
  const scenario::Motion& motion = scenario.motion;
  if (!(motion.time_step_s > 0.0) || !std::isfinite(motion.time_step_s)) {
    throw InputError("motion.time_step_s must be greater than 0");
  }
  if (!(motion.rayleigh_mass_1_s >= 0.0) || !(motion.rayleigh_stiffness_s >= 0.0)) {
    throw InputError("motion.rayleigh_mass_1_s and rayleigh_stiffness_s must not be negative");
  }
  CheckKnown(effects);
  return effects;
}

fem::NodeMatrix MassOf(const BenchBody& body) {
  fem::NodeMatrix mass(body.mesh);
  fem::AddConsistentMass(
      body.mesh, Eigen::VectorXd::Constant(body.mesh.CellCount(), body.density_kg_m3), &mass);
  return mass;
}

bool IsDynamic(const scenario::Motion& motion) {
  return motion.mode == scenario::MotionMode::kDynamic;
}

}  // namespace

Bench::Bench(const robot::RobotDescription& robot, const scenario::Scenario& scenario,
             const Effects& effects, int threads)
    : motion_(scenario.motion),
      tools_(TouchingTools(scenario.tools)),
      all_tools_(scenario.tools),
      body_(MakeBenchBody(robot, scenario.body, Checked(scenario, effects))),
      elastic_(body_.mesh, body_.materials, body_.material_of_cell,
               robot::EmbeddedFibres(body_.fibres)),
      mass_(MassOf(body_)),
      loads_(body_, effects, &mass_),
      viscosity_(body_.mesh, body_.material_of_cell, body_.prony,
                 IsDynamic(motion_) ? motion_.rayleigh_stiffness_s : 0.0),
      softening_(body_, effects, Duration_s(scenario)),
      base_(body_, effects),
      actuators_(body_.cables, effects),
      supply_(body_.chambers, scenario, effects),
      cables_(body_, effects),
      chambers_(body_),
      surface_(body_.mesh, body_.boundary, body_.fixed),
      contacts_(MakeContacts(body_, surface_, tools_, effects)),
      solver_({elastic_, mass_, viscosity_, cables_, chambers_, surface_, contacts_,
               IsDynamic(motion_) ? motion_.rayleigh_mass_1_s : 0.0},
              body_.fixed, threads) {
  const std::vector<Eigen::Isometry3d> poses = ObstaclePoses(body_, surface_, effects);
  obstacle_poses_ = poses;
  ForgetHistory();
}

void Bench::ForgetHistory() {
  const Eigen::VectorXd rest_m = body_.rest_m();
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(rest_m.size());
  state_ = {rest_m, zero, zero};
  now_ = {Eigen::VectorXd::Zero(CommandCount()), {}, zero};
  now_.pose.resize(tools_.size());
  started_ = false;
  base_.Reset();
  cables_.Reset();
  cables_.Evaluate(state_.x_m);
  supply_.Reset(time_s_, OfChambers(now_.command_m));
  chambers_.SetPressures(supply_.pressure_Pa());
  for (Contact& contact : contacts_) contact.Reset();
  viscosity_.Reset(body_.materials, softening_.factor_of_cell(), state_.x_m);
  softening_.Reset(&elastic_, state_.x_m);
}

BenchInputs Bench::Prepare(const Inputs& inputs, const std::vector<PointLoad>& loads) const {
  BenchInputs prepared;
  prepared.command_m = inputs.displacement_m;
  prepared.load_N = loads_.Nodal_N(loads, inputs.base_tilt_deg);
  prepared.pose.resize(tools_.size());
  for (const ToolPose& pose : inputs.tools) {
    for (size_t k = 0; k < tools_.size(); ++k) {
      if (tools_[k].name == pose.tool) prepared.pose[k] = pose.T_robot_tool;
    }
  }
  return prepared;
}

void Bench::PlaceTools(const BenchInputs& inputs) {
  for (size_t k = 0; k < contacts_.size(); ++k) {
    if (k >= tools_.size()) {
      contacts_[k].SetPose(obstacle_poses_[k - tools_.size()]);
    } else if (inputs.pose[k]) {
      contacts_[k].SetPose(*inputs.pose[k]);
    } else {
      contacts_[k].SetAbsent();
    }
  }
}

Status Bench::Balance(const BenchInputs& inputs, double share) {
  cables_.SetPulledIn(share * actuators_.pulled_in_m());
  chambers_.SetPressures(share * supply_.pressure_Pa());
  StepTask task{TimeScheme::QuasiStatic(1.0), share * inputs.load_N, state_.x_m};
  base_.Apply(&task.start_m);
  const Eigen::VectorXd tension_N = cables_.tension_N();
  const Status status = solver_.Solve(task, state_, &next_);
  if (!status.ok()) {
    cables_.SetTensions(tension_N);
    return status;
  }
  state_.x_m = next_.x_m;
  return status;
}

Status Bench::RampUp(const BenchInputs& inputs) {
  constexpr double kSmallestShare = 1.0 / 512.0;
  double done = 0.0;
  double share = 1.0;
  while (done < 1.0) {
    const Status status = Balance(inputs, std::min(1.0, done + share));
    if (status.ok()) {
      done = std::min(1.0, done + share);
      share *= 2.0;
    } else if (share *= 0.5; share < kSmallestShare) {
      return {status.code(), "on the way to the first equilibrium: " + status.message()};
    }
  }
  return Status::Ok();
}

Status Bench::SettleBase(const BenchInputs& inputs) {
  constexpr int kMostRounds = 100;
  constexpr double kTolerance_rad = 1e-8;
  if (!base_.active()) return Status::Ok();
  for (int round = 0; round < kMostRounds; ++round) {
    const Eigen::Vector3d wanted_rad = base_.Wanted_rad(state_.x_m, solver_.residual_N());
    if ((wanted_rad - base_.rotation_rad()).norm() <= kTolerance_rad) return Status::Ok();
    base_.Approach(wanted_rad, 0.5);
    if (Status status = Balance(inputs, 1.0); !status.ok()) return status;
  }
  return {StatusCode::kNotConverged, "the compliant base does not come to rest"};
}

void Bench::BeginHistory(const BenchInputs& inputs) {
  now_ = inputs;
  softening_.Reset(&elastic_, state_.x_m);
  viscosity_.Reset(body_.materials, softening_.factor_of_cell(), state_.x_m);
  cables_.SetFrictionless(false);
  cables_.Commit();
  for (Contact& contact : contacts_) {
    contact.SetFrictionless(false);
    contact.Commit(state_.x_m);
  }
  state_.v_m_s.setZero();
  state_.a_m_s2.setZero();
  drift_m_s_ = state_.v_m_s;
}

Status Bench::Start(double t_s, const Inputs& inputs) {
  if (!std::isfinite(t_s)) return {StatusCode::kInvalidInput, "the time is not finite"};
  if (Status status = CheckInputs(inputs, CommandCount(), all_tools_); !status.ok()) {
    return status;
  }
  ForgetHistory();
  time_s_ = t_s;
  begin_s_ = t_s;
  point_loads_ = loads_.PointLoads(inputs.weights, inputs.base_tilt_deg);
  const BenchInputs first = Prepare(inputs, point_loads_);
  actuators_.Reset(t_s, OfCables(first.command_m));
  supply_.Reset(t_s, OfChambers(first.command_m));
  PlaceTools(first);
  cables_.SetFrictionless(true);
  for (Contact& contact : contacts_) contact.SetFrictionless(true);
  Status status = RampUp(first);
  if (status.ok()) status = SettleBase(first);
  if (!status.ok()) {
    ForgetHistory();
    return status;
  }
  BeginHistory(first);
  started_ = true;
  return status;
}

int Bench::StepCount(double span_s, const BenchInputs& target) const {
  constexpr double kRounding = 1e-6;  // a span of whole steps is cut into just these
  double steps = std::ceil(span_s / motion_.time_step_s - kRounding);
  for (size_t k = 0; k < tools_.size(); ++k) {
    if (!now_.pose[k] || !target.pose[k]) continue;
    const RigidShape& shape = contacts_[k].shape();
    const double travel_m = Travel_m(*now_.pose[k], *target.pose[k], shape.bounding_radius_m());
    steps = std::max(steps, std::ceil(travel_m / (kLargestTravel * shape.half_thickness_m())));
  }
  constexpr double kMostSteps = 1e6;
  return static_cast<int>(std::clamp(steps, 1.0, kMostSteps));
}

Status Bench::Advance(double t_s, const Inputs& inputs) {
  if (!started_) return {StatusCode::kNotRun, "the robot was not started"};
  if (!std::isfinite(t_s) || !(t_s > time_s_)) {
    return {StatusCode::kInvalidInput, "time must rise"};
  }
  if (Status status = CheckInputs(inputs, CommandCount(), all_tools_); !status.ok()) {
    return status;
  }
  std::vector<PointLoad> loads = loads_.PointLoads(inputs.weights, inputs.base_tilt_deg);
  const BenchInputs target = Prepare(inputs, loads);
  const BenchInputs start = now_;
  const double start_s = time_s_;
  const int steps = StepCount(t_s - start_s, target);
  for (int k = 1; k <= steps; ++k) {
    const double fraction = static_cast<double>(k) / steps;
    const double end_s = k == steps ? t_s : start_s + fraction * (t_s - start_s);
    corrections_end_ = cost().corrections + kMostCorrections;
    const Status status = StepTo(end_s, Between(start, target, fraction), kMostHalvings);
    if (!status.ok()) return status;
  }
  point_loads_ = std::move(loads);
  return Status::Ok();
}

Status Bench::StepTo(double t_s, const BenchInputs& inputs, int halvings_left) {
  const Status status = Step(t_s, inputs);
  if (status.ok() || halvings_left == 0 || cost().corrections >= corrections_end_) return status;
  const double middle_s = 0.5 * (time_s_ + t_s);
  if (!(middle_s > time_s_) || !(t_s > middle_s)) return status;
  const BenchInputs middle = Between(now_, inputs, 0.5);
  if (Status first = StepTo(middle_s, middle, halvings_left - 1); !first.ok()) return first;
  return StepTo(t_s, inputs, halvings_left - 1);
}

bool Bench::IsTouched() const {
  return std::any_of(contacts_.begin(), contacts_.end(),
                     [](const Contact& contact) { return contact.touching(); });
}

Status Bench::Step(double t_s, const BenchInputs& inputs) {
  const double h_s = t_s - time_s_;
  const bool undamped = !viscosity_.active() && motion_.rayleigh_mass_1_s == 0.0;
  StepTask task{.scheme = IsDynamic(motion_)
                              ? TimeScheme::GeneralisedAlpha(h_s, undamped ? 1.0 : kSpectralRadius)
                              : TimeScheme::QuasiStatic(h_s),
                .load_N = {},
                .start_m = {}};
  const double balance_s = task.scheme.balance_s();
  actuators_.Propose(t_s, OfCables(inputs.command_m));
  cables_.SetPulledIn(actuators_.pulled_in_m());
  const Eigen::VectorXd pressure_Pa = chambers_.pressure_Pa();
  supply_.Propose(t_s, OfChambers(inputs.command_m));
  chambers_.SetPressures(supply_.pressure_Pa());
  PlaceTools(inputs);
  viscosity_.Prepare(balance_s);
  task.load_N = now_.load_N + balance_s / h_s * (inputs.load_N - now_.load_N);
  const Eigen::VectorXd tension_N = cables_.tension_N();
  if (IsTouched()) {
    task.start_m = state_.x_m + h_s * drift_m_s_;
    solver_.FollowTools(task, state_, h_s / last_h_s_, &task.start_m);
  } else {
    task.scheme.Predict(state_, &task.start_m);
  }
  base_.Apply(&task.start_m);
  Status status = solver_.Solve(task, state_, &next_);
  if (status.code() == StatusCode::kInverted) {
    task.start_m = state_.x_m;
    base_.Apply(&task.start_m);
    cables_.SetTensions(tension_N);
    status = solver_.Solve(task, state_, &next_);
  }
  if (status.ok()) status = FollowSoftening(&task);
  if (!status.ok()) {
    softening_.Restore(&elastic_);
    cables_.SetTensions(tension_N);
    cables_.Evaluate(state_.x_m);
    chambers_.SetPressures(pressure_Pa);
    PlaceTools(now_);
    for (Contact& contact : contacts_) contact.Evaluate(surface_, state_.x_m);
    return status;
  }
  Commit(t_s, inputs, h_s);
  return status;
}

/// Steps of a dynamic motion are so short that what they soften may wait for the next, as does what
/// has not settled after so many rounds.
Status Bench::FollowSoftening(StepTask* task) {
  constexpr int kMostRounds = 12;
  constexpr double kSettled = 2e-3;
  if (!softening_.answers_strain() || IsDynamic(motion_)) return Status::Ok();
  for (int round = 0; round < kMostRounds; ++round) {
    if (softening_.Approach(&elastic_, next_.x_m) < kSettled) break;
    task->start_m = next_.x_m;
    if (Status status = solver_.Solve(*task, state_, &next_); !status.ok()) return status;
  }
  return Status::Ok();
}

void Bench::Commit(double t_s, const BenchInputs& inputs, double h_s) {
  actuators_.Commit();
  supply_.Commit();
  cables_.Commit();
  for (Contact& contact : contacts_) contact.Commit(next_.x_m);
  viscosity_.Advance(body_.materials, softening_.factor_of_cell(), next_.x_m, h_s);
  softening_.Update(&elastic_, next_.x_m, t_s - begin_s_);
  if (base_.active()) {
    base_.Approach(base_.Wanted_rad(next_.x_m, solver_.residual_N()), CompliantBase::Share(h_s));
  }
  drift_m_s_ = (next_.x_m - state_.x_m) / h_s;
  last_h_s_ = h_s;
  std::swap(state_, next_);
  now_ = inputs;
  time_s_ = t_s;
}

Eigen::Vector3d Bench::SupportForce_N() const {
  Eigen::Vector3d force_N = Eigen::Vector3d::Zero();
  for (int node = 0; node < body_.mesh.NodeCount(); ++node) {
    if (body_.fixed.col(node).all()) force_N += solver_.residual_N().segment<3>(3 * node);
  }
  return force_N;
}

double Bench::KineticEnergy_J() const {
  return IsDynamic(motion_) ? 0.5 * mass_.Quadratic(state_.v_m_s) : 0.0;
}

double Bench::TotalEnergy_J() const {
  double min_J = 0.0;
  return elastic_.Energy(state_.x_m, &min_J) - now_.load_N.dot(state_.x_m - elastic_.rest_m()) +
         KineticEnergy_J();
}

}  // namespace palpate::virtual_robot
