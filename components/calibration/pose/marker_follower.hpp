// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "components/calibration/pose/pose_and_inputs.hpp"
#include "libs/core/status.hpp"
#include "libs/fem/static_solver.hpp"
#include "libs/robot/compliance.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::calibration {

/// Configuration of the model under cable tensions, and the compliance of the sighted markers.
class MarkerFollower {
 public:
  MarkerFollower(robot::RobotModel& model, const std::vector<MarkerSighting>& sightings);

  /// Equilibrium under these tensions, from the undeformed body.
  Status Start(const Eigen::VectorXd& lambda_a_N);
  /// Tangent and compliances (3)-(5) at the configuration; where it has no tangent, at the last
  /// equilibrium before it.
  Status Linearise();
  /// Only delta_e^free and delta_a^free, with the tangent of the last Linearise: a tenth of the
  /// work. After MoveTo.
  void KeepTangent();
  /// (6) to these tensions; where that fails, the equilibrium under them, or under part of the
  /// change. Needs Linearise or KeepTangent before it.
  Status MoveTo(const Eigen::VectorXd& lambda_a_N);
  /// Solves for the equilibrium under the present tensions.
  Status Balance();

  const robot::Compliance& compliance() const { return compliance_; }
  const fem::StaticState& state() const { return state_; }
  const Eigen::VectorXd& lambda_a_N() const { return state_.multipliers_N; }
  /// [3 x sightings] of the model's markers in the configuration, robot frame.
  Eigen::Matrix3Xd Markers_m() const;
  /// Tensions at the last tangent.
  const Eigen::VectorXd& tangent_lambda_a_N() const { return tangent_lambda_a_N_; }
  /// Residual over the size of the forces after MoveTo.
  double balance_error() const { return balance_error_; }
  int continuation_steps() const { return restorations_; }

 private:
  Status TryLinearise();
  Status TakeLinearStep(const Eigen::VectorXd& lambda_a_N);
  Status FollowEquilibrium(const Eigen::VectorXd& lambda_a_N);

  robot::RobotModel& model_;
  std::vector<robot::ObservationRow> rows_;
  robot::Compliance compliance_;
  fem::StaticSolver equilibrium_;  ///< for the load continuation
  Eigen::VectorXd weight_N_;       ///< [3n]
  fem::StaticState state_;
  fem::StaticState balanced_;  ///< the last equilibrium
  Eigen::VectorXd tangent_lambda_a_N_;
  double balance_error_ = 0.0;
  int restorations_ = 0;
};

}  // namespace palpate::calibration
