// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "components/diagnosis/forward/obstacle.hpp"
#include "libs/core/status.hpp"
#include "libs/fem/equilibrium_step.hpp"
#include "libs/robot/robot_model.hpp"
#include "libs/robot/sensitivity/sensitivity_solver.hpp"

namespace palpate::diagnosis {

/// Brings a robot into balance at an obstacle. From how far the nodes near it yield to each other's
/// forces (W, as eq. 4 of the paper has it for cables) follows a linear complementarity problem for
/// what the obstacle presses with; the body goes a step on towards balance under that, and so in
/// turn. The tangents are the free body's: one serves whatever touches, and many equilibria near
/// each other.
class ObstacleBalance {
 public:
  /// Both must outlive it; the model's last constraint is the obstacle (ObstacleContact).
  ObstacleBalance(const Obstacle& obstacle, robot::RobotModel* model);

  /// As StaticSolver::Solve, of cables as commanded. `force_N` [nodes of the obstacle's surface, or
  /// empty: none] is what the obstacle presses with: a guess before, and what it does after.
  Status Solve(const std::vector<robot::ActuatorCommand>& cables, const fem::LoadState& loads,
               fem::StaticState* state, Eigen::VectorXd* force_N);

 private:
  Status StepTogether(const std::vector<robot::ActuatorCommand>& cables,
                      const Eigen::VectorXd& others_N, fem::LoadState* loads,
                      fem::StaticState* state);
  Status Step(const fem::LoadState& loads, const fem::StaticState& state, bool renew);
  Status BalanceInTurn(const std::vector<robot::ActuatorCommand>& cables,
                       const Eigen::VectorXd& others_N, fem::LoadState* loads,
                       fem::StaticState* state);
  double UpdateDepths(const fem::StaticState& state);
  bool CoversWhatTouches() const;
  Status UpdateCompliance(const std::vector<robot::ActuatorCommand>& cables,
                          const fem::StaticState& state);
  void PressAgain();

  const Obstacle& obstacle_;
  robot::RobotModel& model_;
  robot::SensitivitySolver sensitivity_;
  fem::EquilibriumStep step_;
  fem::StaticState next_;
  Eigen::VectorXd depth_m_;         ///< [nodes of the surface]
  Eigen::VectorXd force_N_;         ///< [nodes of the surface]
  std::vector<int> active_;         ///< places in the surface's nodes, ascending
  Eigen::MatrixXd compliance_m_N_;  ///< [evaluated x evaluated], W
  int compliance_of_ = -1;          ///< Linearisation::factor_count() that it is of
};

}  // namespace palpate::diagnosis
