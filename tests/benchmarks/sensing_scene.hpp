// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <vector>

#include "components/force_estimation/fit/force_newton.hpp"
#include "libs/fem/sparse/solver_settings.hpp"
#include "libs/robot/robot_model.hpp"
#include "tests/benchmarks/robots.hpp"

namespace palpate::benchmarks {

/// A robot that is touched on top and at its side while its first cable moves to and fro by 1 mm a
/// frame: its feature points are the markers that are seen, exact and without noise.
class SensingScene {
 public:
  enum class Update {
    kOneStep,    ///< one linearisation a frame, and the residual of where it leads
    kWithChord,  ///< and a chord step where it helps
    kConverged,  ///< to a relative error of 1e-8
  };

  struct Settings {
    int feature_points = 51;
    Update update = Update::kOneStep;
    fem::SolverSettings solver;
  };

  /// Throws InputError for a robot that cannot be built, RunError where a frame has no equilibrium.
  SensingScene(const NamedRobot& robot, const Settings& settings);
  /// The same frames as `computed`, of the same robot and feature points, without computing them.
  SensingScene(const SensingScene& computed, const Settings& settings);
  SensingScene(const SensingScene&) = delete;
  SensingScene& operator=(const SensingScene&) = delete;

  /// The whole update with the next frame: tangent, factor, W, QP, state. Throws RunError where it
  /// does not come to what was asked for.
  void TakeFrame();

  robot::RobotModel& model() { return model_; }
  /// Before the first frame, with both contact forces.
  const force_estimation::ModelState& first_state() const { return first_state_; }
  /// The loads that `first_state` balances.
  const Eigen::VectorXd& external_force_N() const { return external_force_N_; }
  int qp_steps() const { return qp_steps_; }  ///< of the last frame, each with its linearisation

 private:
  struct Frame {
    std::vector<robot::ActuatorCommand> cables;
    force_estimation::RowTargets targets;
  };

  SensingScene(robot::RobotBody body, const Settings& settings);

  void AddFrame(int step, fem::StaticState* equilibrium);

  robot::RobotModel model_;
  std::vector<force_estimation::FitSite> sites_;
  force_estimation::ForceNewton fitter_;
  Update update_;
  std::vector<Frame> frames_;  ///< the first half of the cycle; the way back is the same
  size_t next_ = 0;
  force_estimation::ModelState first_state_;
  force_estimation::ModelState state_;
  Eigen::VectorXd external_force_N_;
  int qp_steps_ = 0;
};

}  // namespace palpate::benchmarks
