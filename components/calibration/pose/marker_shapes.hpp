// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>

#include "libs/core/status.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::calibration {

/// Marker positions as functions of the cable tensions: each coordinate is a quadratic polynomial,
/// fitted to solved equilibria. Robot frame.
class MarkerShapes {
 public:
  MarkerShapes() = default;
  /// `tensions_N` [a x s] and marker positions under them, `positions_m` [3m x s], s at least
  /// (a + 1) (a + 2) / 2. `most_tension_N` [a] > 0: upper end of the range from 0.
  MarkerShapes(const Eigen::MatrixXd& tensions_N, const Eigen::MatrixXd& positions_m,
               const Eigen::VectorXd& most_tension_N);

  int MarkerCount() const { return static_cast<int>(coefficients_.rows() / 3); }
  int CableCount() const { return static_cast<int>(most_tension_N_.size()); }
  const Eigen::VectorXd& most_tension_N() const { return most_tension_N_; }
  /// RMS distance between polynomial and solved markers, m.
  double error_m() const { return error_m_; }
  /// Smallest and largest distance of each two markers in the solved shapes [m x m], m.
  const Eigen::MatrixXd& shortest_m() const { return shortest_m_; }
  const Eigen::MatrixXd& longest_m() const { return longest_m_; }
  /// [3 x m] mean over the solved shapes.
  const Eigen::Matrix3Xd& mean_m() const { return mean_m_; }
  /// Largest distance of any marker from its mean, m.
  double reach_m() const { return reach_m_; }

  Eigen::Matrix3Xd Positions_m(const Eigen::VectorXd& tension_N) const;
  /// [3m x a] d position / d tension, m/N.
  Eigen::MatrixXd Derivative(const Eigen::VectorXd& tension_N) const;

 private:
  void MeasureDistances(const Eigen::MatrixXd& positions_m);

  Eigen::VectorXd most_tension_N_;
  Eigen::MatrixXd coefficients_;  ///< [3m x terms] of monomials in tension / most tension
  Eigen::MatrixXd shortest_m_, longest_m_;
  Eigen::Matrix3Xd mean_m_;
  double reach_m_ = 0.0;
  double error_m_ = 0.0;
};

struct SolvedShapes {
  Status status;
  MarkerShapes shapes;
};

/// Solves `model` at Halton points of 0 to `most_tension_N` [a], three per coefficient of the
/// polynomial. Fails with the first equilibrium that does.
SolvedShapes SolveMarkerShapes(robot::RobotModel& model, const Eigen::VectorXd& most_tension_N);

}  // namespace palpate::calibration
