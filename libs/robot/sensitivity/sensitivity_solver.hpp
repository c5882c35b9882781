// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "libs/core/status.hpp"
#include "libs/fem/interpolation_weights.hpp"
#include "libs/robot/robot_model.hpp"
#include "libs/robot/sensitivity/cable_terms.hpp"
#include "libs/robot/sensitivity/equilibrium_point.hpp"
#include "libs/robot/sensitivity/factor.hpp"
#include "libs/robot/sensitivity/parameter.hpp"

namespace palpate::robot {

/// How an equilibrium moves with parameters p, to first order and exactly. With the load column
/// r_p = dr/dp at fixed x and tensions T (held nodes moved along), H_c the direction of cable c's
/// forces and l_c its length,
///   K dx/dp = r_p + sum_c H_c dT_c/dp,
///   taut and driven by displacement: dl_c/dp = d(commanded length)/dp;
///   driven by tension:               dT_c/dp = d(commanded tension)/dp;
///   slack, not driven, at max_tension_N or beyond: dT_c/dp = 0.
/// So slack cables stay slack and have no tension, and one that pulls at its limit keeps pulling
/// with it; where a cable is just about to change between these, the derivative is one-sided.
/// K is factorised once; one further column for each parameter that loads the body, for each taut
/// cable and for each turn of a cable with friction, all solved in one block. That friction makes K
/// unsymmetric by one rank for each turn, which the Woodbury formula adds.
///
/// Buffers grow at first; called again with the same sizes, it allocates nothing, friction and
/// parameters that move held nodes, guides or the rest shape aside. For one thread.
class SensitivitySolver {
 public:
  /// `model` must outlive it and keep its mesh.
  explicit SensitivitySolver(RobotModel& model);

  /// Everything below is about this equilibrium and these parameters. `cables` are the commands
  /// that `state` was solved with. Not ok where the state is inverted or not finite, K has no
  /// Cholesky factor (also where only the cables' held lengths make the balance stable), or two
  /// taut cables are collinear (kUnobservable); then there are no results: ParameterCount() is 0.
  Status Compute(const std::vector<ActuatorCommand>& cables, const fem::StaticState& state,
                 std::span<const ParameterPtr> parameters, Factor factor = Factor::kRenew);

  int ParameterCount() const { return static_cast<int>(columns_of_.size()); }

  /// [3 x p] motion of a point of the body, m per unit of each parameter.
  Eigen::Matrix3Xd PointMotion(const fem::InterpolationWeights& point) const;
  /// [3 points x p] of many points, into memory that is kept.
  void PointMotions(std::span<const fem::InterpolationWeights> points,
                    Eigen::MatrixXd* motions_m) const;
  /// [3n] motion of all nodes with one parameter.
  void NodalMotion(int parameter, Eigen::VectorXd* motion_m) const;
  /// [cables x p] of the lengths outside the actuators, m, and of the tensions at the actuators, N.
  const Eigen::MatrixXd& length_m() const { return length_m_; }
  const Eigen::MatrixXd& tension_N() const { return tension_N_; }

 private:
  Status TryCompute(const std::vector<ActuatorCommand>& cables, const fem::StaticState& state,
                    std::span<const ParameterPtr> parameters, Factor factor);
  void DescribeParameters(std::span<const ParameterPtr> parameters);
  void FillColumns();
  Status CoupleFriction();
  Status EliminateTautCables();

  RobotModel& model_;
  EquilibriumPoint point_;
  CableTerms cables_;
  std::vector<ParameterColumn> columns_of_;
  std::vector<int> load_of_;  ///< [p] which of the load columns, or -1: loads nothing
  Eigen::Index loads_ = 0;
  Eigen::MatrixXd columns_;  ///< [Size x >= taut + loads + turns], in this order
  Eigen::VectorXd nodal_;    ///< [3n]
  Eigen::MatrixXd commanded_length_m_, length_m_, tension_N_;
};

}  // namespace palpate::robot
