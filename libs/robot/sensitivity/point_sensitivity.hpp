// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "libs/core/status.hpp"
#include "libs/fem/interpolation_weights.hpp"
#include "libs/robot/observation_row.hpp"
#include "libs/robot/robot_model.hpp"
#include "libs/robot/sensitivity/cable_terms.hpp"
#include "libs/robot/sensitivity/equilibrium_point.hpp"
#include "libs/robot/sensitivity/factor.hpp"
#include "libs/robot/sensitivity/parameter.hpp"

namespace palpate::robot {

/// What SensitivitySolver gives, for what is observed of the body (a marker's coordinates, a place
/// of the surface along its normal): the same derivatives by the adjoint method. With R the rows of
/// what is observed and of the cables' lengths, and K'
/// the tangent with friction, R' K'^-1 r_p = (K'^-T R)' r_p: as many columns to solve as there are
/// rows, however many parameters there are, and parameters that load few nodes cost next to
/// nothing. To be preferred where there are more parameters than coordinates.
/// Keeps 8 bytes for each row and nodal coordinate. For one thread.
class PointSensitivity {
 public:
  /// `model` must outlive it and keep its mesh.
  PointSensitivity(RobotModel& model, std::vector<ObservationRow> rows);
  /// Of x, y and z of each point.
  PointSensitivity(RobotModel& model, const std::vector<fem::InterpolationWeights>& points);

  /// What is observed from the next Compute on.
  void SetRows(std::vector<ObservationRow> rows);

  /// As SensitivitySolver::Compute, with the same refusals.
  Status Compute(const std::vector<ActuatorCommand>& cables, const fem::StaticState& state,
                 std::span<const ParameterPtr> parameters, Factor factor = Factor::kRenew);
  /// The same at the state of the last Compute, which was ok, with the rows, the tangent and the
  /// dead loads that it had: nothing is solved again. Commands may be others.
  Status ComputeAgain(const std::vector<ActuatorCommand>& cables, const fem::StaticState& state,
                      std::span<const ParameterPtr> parameters);

  int ParameterCount() const { return static_cast<int>(motion_m_.cols()); }

  /// [rows x p] motion of what is observed, m per unit of each parameter.
  const Eigen::MatrixXd& motion_m() const { return motion_m_; }
  /// [cables x p] of the lengths outside the actuators, m, and of the tensions at the actuators, N.
  const Eigen::MatrixXd& length_m() const { return length_m_; }
  const Eigen::MatrixXd& tension_N() const { return tension_N_; }

 private:
  Status TryCompute(const std::vector<ActuatorCommand>& cables, const fem::StaticState& state,
                    std::span<const ParameterPtr> parameters, Factor factor);
  Status Describe(std::span<const ParameterPtr> parameters);
  Status SolveRows();
  void FillRows();
  Status CoupleFriction();
  void DescribeParameters(std::span<const ParameterPtr> parameters);
  void MoveWithBase(Eigen::Index parameter);
  Status PullTautCables();
  void Clear();

  RobotModel& model_;
  std::vector<ObservationRow> observed_;
  EquilibriumPoint point_;
  CableTerms cables_;
  Eigen::Index rows_ = 0;          ///< lengths of all cables, then what is observed
  Eigen::MatrixXd columns_;        ///< [Size x >= rows + turns]
  Eigen::MatrixXd per_force_m_N_;  ///< [rows x 3n] K'^-T R, transposed; 0 in held directions
  ParameterColumn column_;         ///< of one parameter after the other
  Eigen::MatrixXd distributed_N_;  ///< [3n x >= those with distributed forces]
  std::vector<Eigen::Index> distributed_;  ///< their parameters
  Eigen::MatrixXd response_m_;             ///< [rows x p] to loads at fixed tensions
  Eigen::MatrixXd commanded_length_m_, length_m_, tension_N_, motion_m_;
  Eigen::VectorXd nodal_;  ///< [3n]
};

}  // namespace palpate::robot
