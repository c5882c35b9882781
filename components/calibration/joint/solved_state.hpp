// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "libs/fem/interpolation_weights.hpp"
#include "libs/fem/load_state.hpp"
#include "libs/robot/sensitivity/sensitivity_solver.hpp"

namespace palpate::calibration {

/// Sizes of moves over the body's extent. Larger ones save solves and leave larger errors.
struct SolvedStateTuning {
  double tiny_move = 1e-6;   ///< extrapolated without a solve; the error is the square of it
  double small_move = 0.05;  ///< a start for the solver
};
inline constexpr SolvedStateTuning kSolvedStateTuning;

/// Longest side of the bounding box of all nodes [3n], m.
double ExtentOf(const Eigen::VectorXd& x_m);

/// A solved equilibrium, or the prediction of a Newton step, with the derivatives of its nodes with
/// respect to the variables. A solve from its extrapolation takes a step or two. Changes below the
/// static solver's tolerance are extrapolated without a solve, so that a line search does not see
/// rounding errors.
class SolvedState {
 public:
  /// Size of the nodal displacements that a change of the variables causes, to first order.
  enum class Move {
    kUnknown,  ///< no state, or beyond the range of the derivatives
    kSmall,    ///< the extrapolation is a start for the solver
    kTiny,     ///< the second-order error is below the static solver's tolerance
  };

  /// A point of the body.
  struct Place {
    Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
    Eigen::Matrix3Xd motion_m;  ///< [3 x column()] per unit of each variable
  };

  /// `state` at `variables`; parameter p of `sensitivity` changes by factor[p] per unit of variable
  /// column[p].
  void Keep(const fem::StaticState& state, const Eigen::VectorXd& variables,
            const std::vector<Eigen::Index>& column, const std::vector<double>& factor,
            const robot::SensitivitySolver& sensitivity);
  /// The same derivatives about another state nearby.
  void MoveBase(const fem::StaticState& state, const Eigen::VectorXd& variables);

  /// Extrapolates nodes and multipliers to other variables; kUnknown leaves `state` unchanged.
  Move MoveTo(const Eigen::VectorXd& variables, fem::StaticState* state) const;
  /// The same for a change of any size.
  void Extrapolate(const Eigen::VectorXd& variables, fem::StaticState* state) const;

  /// Variables that move the body.
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
