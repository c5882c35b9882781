// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "components/virtual_robot/actuator_chain.hpp"
#include "components/virtual_robot/bench_body.hpp"
#include "components/virtual_robot/bench_inputs.hpp"
#include "components/virtual_robot/compliant_base.hpp"
#include "components/virtual_robot/external_loads.hpp"
#include "components/virtual_robot/pressure_supply.hpp"
#include "components/virtual_robot/softening.hpp"
#include "components/virtual_robot/step_solver.hpp"
#include "libs/fem/viscosity.hpp"
#include "libs/scenario/scenario.hpp"

namespace palpate::virtual_robot {

/// The robot of the bench in time: what VirtualRobot does, without its outputs.
class Bench {
 public:
  /// Of the highest frequencies so much is left after a step, unless nothing damps the body at all:
  /// then 1, and energy is conserved.
  static constexpr double kSpectralRadius = 0.8;
  /// A tool moves at most by this share of its half thickness in one step.
  static constexpr double kLargestTravel = 0.25;

  /// In one step, halved ones together; beyond, it is given up.
  static constexpr int kMostCorrections = 400;

  Bench(const robot::RobotDescription& robot, const scenario::Scenario& scenario,
        const Effects& effects, int threads);
  Bench(const Bench&) = delete;
  Bench& operator=(const Bench&) = delete;

  Status Start(double t_s, const Inputs& inputs);
  Status Advance(double t_s, const Inputs& inputs);

  double time_s() const { return time_s_; }
  const BenchBody& body() const { return body_; }
  const MotionState& state() const { return state_; }
  const CableSystem& cable_system() const { return cables_; }
  const ChamberSystem& chamber_system() const { return chambers_; }
  const ActuatorChain& actuators() const { return actuators_; }
  const PressureSupply& supply() const { return supply_; }
  const ContactSurface& surface() const { return surface_; }
  const std::vector<Contact>& contacts() const { return contacts_; }
  /// [cables, then chambers] m, Pa
  const Eigen::VectorXd& command_m() const { return now_.command_m; }
  const std::vector<PointLoad>& point_loads() const { return point_loads_; }
  const StepCost& cost() const { return solver_.cost(); }
  /// Of the body on its clamp, as the last step left it.
  Eigen::Vector3d SupportForce_N() const;
  double KineticEnergy_J() const;
  double TotalEnergy_J() const;

 private:
  BenchInputs Prepare(const Inputs& inputs, const std::vector<PointLoad>& loads) const;
  void PlaceTools(const BenchInputs& inputs);
  void ForgetHistory();
  /// The balance of a share of all loads and commands, from the present state on.
  Status Balance(const BenchInputs& inputs, double share);
  Status RampUp(const BenchInputs& inputs);
  Status SettleBase(const BenchInputs& inputs);
  void BeginHistory(const BenchInputs& inputs);
  int StepCount(double span_s, const BenchInputs& target) const;
  /// One step to `t_s`, halved where it fails.
  Status StepTo(double t_s, const BenchInputs& inputs, int halvings_left);
  Status Step(double t_s, const BenchInputs& inputs);
  int CommandCount() const { return cables_.CableCount() + chambers_.ChamberCount(); }
  Eigen::VectorXd OfCables(const Eigen::VectorXd& command) const {
    return command.head(cables_.CableCount());
  }
  Eigen::VectorXd OfChambers(const Eigen::VectorXd& command) const {
    return command.tail(chambers_.ChamberCount());
  }
  bool IsTouched() const;
  Status FollowSoftening(StepTask* task);
  void Commit(double t_s, const BenchInputs& inputs, double h_s);

  scenario::Motion motion_;
  std::vector<scenario::Tool> tools_;  ///< that touch; contacts_ in their order, then obstacles
  std::vector<scenario::Tool> all_tools_;
  BenchBody body_;
  fem::ElasticBody elastic_;
  fem::NodeMatrix mass_;
  ExternalLoads loads_;
  fem::Viscosity viscosity_;
  Softening softening_;
  CompliantBase base_;
  ActuatorChain actuators_;
  PressureSupply supply_;
  CableSystem cables_;
  ChamberSystem chambers_;
  ContactSurface surface_;
  std::vector<Contact> contacts_;
  std::vector<Eigen::Isometry3d> obstacle_poses_;
  StepSolver solver_;

  bool started_ = false;
  int corrections_end_ = 0;  ///< of the present step
  double last_h_s_ = 1.0;    ///< of the last step
  double begin_s_ = 0.0;
  double time_s_ = 0.0;
  MotionState state_;
  MotionState next_;
  Eigen::VectorXd drift_m_s_;  ///< [3n] mean velocity in the last step
  BenchInputs now_;
  std::vector<PointLoad> point_loads_;
};

}  // namespace palpate::virtual_robot
