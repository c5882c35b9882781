// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "libs/fem/equilibrium_step.hpp"
#include "libs/fem/load_state.hpp"
#include "libs/fem/newton_loop.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::robot {

/// The model following its actuators and given forces from frame to frame, each by SolveNewton
/// (newton_loop.hpp): what a simulation beside the real robot needs. A frame's error is the larger
/// of the residual over the size of the forces (ForceScale_N) and the missed cable length over the
/// cable's rest length. Nothing is allocated after the first frame.
class FrameTracker final : private fem::NewtonProblem {
 public:
  /// `model` must outlive the tracker; no other code may use its linearisation during Follow.
  FrameTracker(RobotModel& model, const fem::FrameSettings& settings);

  /// Goes on from `state`, an equilibrium (RobotModel::Solve).
  void Start(const fem::StaticState& state);

  /// Moves towards the balance of weight, `cables` and `force_N` [3n] (nodal dead loads beside the
  /// weight). After a frame that diverged the state is the last good one. Needs Start before it.
  const fem::FrameOutcome& Follow(const std::vector<ActuatorCommand>& cables,
                                  const Eigen::VectorXd& force_N,
                                  const fem::TimeBudget& budget = {});

  /// Where the last frame ended; an equilibrium only where it converged.
  const fem::StaticState& state() const { return state_; }
  /// The last equilibrium, with its loads.
  const fem::StaticState& last_good() const { return last_good_; }

 private:
  Status PrepareExactStep() override;
  Status PrepareChordStep() override;
  Status Try(double length, bool last) override;
  double TrialError() const override { return trial_error_; }
  void AcceptTrial() override;

  void SetLoads(const std::vector<ActuatorCommand>& cables, const Eigen::VectorXd& force_N);
  double Error() const;

  RobotModel& model_;
  fem::FrameSettings settings_;
  fem::EquilibriumStep step_;
  fem::StaticState state_, last_good_;
  Eigen::VectorXd trial_x_m_, trial_multipliers_N_;
  double trial_error_ = 0.0;
  fem::FrameOutcome outcome_;
};

}  // namespace palpate::robot
