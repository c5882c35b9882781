// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "libs/fem/node_weights.hpp"
#include "libs/robot/sensitivity/sensitivity_solver.hpp"

namespace palpate::calibration {

/// An equilibrium that was solved, and how its nodes move with the variables to first order. A
/// solve that starts from there ends in a step or two; and changes too small to leave the static
/// solver's tolerance still move the body as its derivatives say, so that a line search among them
/// does not look at rounding.
class SolvedState {
 public:
  /// How far variables lead from the state, by its derivatives.
  enum class Move {
    kUnknown,  ///< nothing was solved, or further than derivatives are good for
    kSmall,    ///< a start for the solver
    kTiny,     ///< what derivatives leave out is below the static solver's tolerance
  };

  /// x_m [3n] at `variables`; parameter p of `sensitivity` changes by factor[p] with a unit of
  /// variable column[p].
  void Keep(const Eigen::VectorXd& x_m, const Eigen::VectorXd& variables,
            const std::vector<Eigen::Index>& column, const std::vector<double>& factor,
            const robot::SensitivitySolver& sensitivity);

  /// Gives the nodes at other variables; leaves `x_m` where the move is unknown.
  Move MoveTo(const Eigen::VectorXd& variables, Eigen::VectorXd* x_m) const;

  /// Variables that the body moves with.
  const std::vector<Eigen::Index>& column() const { return column_; }
  /// [3 x column()] motion of a point of the body per unit of each.
  Eigen::Matrix3Xd PointMotion(const fem::NodeWeights& point) const;

 private:
  Eigen::VectorXd x_m_;
  Eigen::VectorXd variables_;
  std::vector<Eigen::Index> column_;
  Eigen::MatrixXd motion_m_;  ///< [3n x column_]
};

}  // namespace palpate::calibration
