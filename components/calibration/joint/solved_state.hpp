// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "libs/fem/interpolation_weights.hpp"
#include "libs/fem/load_state.hpp"
#include "libs/robot/sensitivity/sensitivity_solver.hpp"

namespace palpate::calibration {

/// Size of the box around all nodes [3n], its longest side, m.
double ExtentOf(const Eigen::VectorXd& x_m);

/// An equilibrium that was solved, or the one that a Newton step leads to, and how its nodes move
/// with the variables to first order. A solve that starts from there ends in a step or two; and
/// changes too small to leave the static solver's tolerance still move the body as its derivatives
/// say, so that a line search among them does not look at rounding.
class SolvedState {
 public:
  /// How far variables lead from the state, by its derivatives.
  enum class Move {
    kUnknown,  ///< nothing was solved, or further than derivatives are good for
    kSmall,    ///< a start for the solver
    kTiny,     ///< what derivatives leave out is below the static solver's tolerance
  };
  /// Of the body's extent. What first order leaves out of a tiny move is its square.
  static constexpr double kTinyMove = 1e-6;

  /// A point of the body.
  struct Place {
    Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
    Eigen::Matrix3Xd motion_m;  ///< [3 x column()] per unit of each variable
  };

  /// `state` at `variables`; parameter p of `sensitivity` changes by factor[p] with a unit of
  /// variable column[p].
  void Keep(const fem::StaticState& state, const Eigen::VectorXd& variables,
            const std::vector<Eigen::Index>& column, const std::vector<double>& factor,
            const robot::SensitivitySolver& sensitivity);
  /// The same derivatives about another state, which is near.
  void MoveBase(const fem::StaticState& state, const Eigen::VectorXd& variables);

  /// Gives nodes and multipliers at other variables; leaves `state` where the move is unknown.
  Move MoveTo(const Eigen::VectorXd& variables, fem::StaticState* state) const;
  /// The same however far it leads.
  void Extrapolate(const Eigen::VectorXd& variables, fem::StaticState* state) const;

  /// Variables that the body moves with.
  const std::vector<Eigen::Index>& column() const { return column_; }
  Place PlaceOf(const fem::InterpolationWeights& point, const Eigen::VectorXd& variables) const;

 private:
  Eigen::VectorXd ChangeTo(const Eigen::VectorXd& variables) const;

  Eigen::VectorXd x_m_;
  Eigen::VectorXd multipliers_N_;
  Eigen::VectorXd variables_;
  std::vector<Eigen::Index> column_;
  Eigen::MatrixXd motion_m_;           ///< [3n x column_]
  Eigen::MatrixXd multiplier_rise_N_;  ///< [constraints x column_]
};

}  // namespace palpate::calibration
