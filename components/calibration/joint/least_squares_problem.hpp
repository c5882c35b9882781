// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "libs/core/status.hpp"

namespace palpate::calibration {

/// Values and first derivatives of a LeastSquaresProblem at one point. The problem may add rows
/// beyond the residuals of data (priors).
struct LeastSquaresPoint {
  Eigen::VectorXd residual;             ///< [rows] each over its standard deviation
  Eigen::MatrixXd jacobian;             ///< [rows x variables]
  Eigen::VectorXd constraint;           ///< [constraints]
  Eigen::MatrixXd constraint_jacobian;  ///< [constraints x variables]
};

/// Residuals with one robust weight: of one marker, or of one surface point.
struct RobustBlock {
  Eigen::Index first_row = 0;
  Eigen::Index rows = 0;
};

/// Minimise 1/2 sum of rho(|r_block|) + 1/2 sum of the other r^2 within bounds and constraints;
/// rho(r) = r^2 up to Huber's threshold.
class LeastSquaresProblem {
 public:
  virtual ~LeastSquaresProblem() = default;

  virtual Eigen::VectorXd Start() const = 0;
  /// [variables x 2] lower and upper bounds; infinite where there is none.
  virtual Eigen::MatrixX2d Bounds() const = 0;
  /// [constraints x 2]
  virtual Eigen::MatrixX2d ConstraintBounds() const = 0;
  virtual std::vector<RobustBlock> RobustBlocks() const = 0;
  /// Not ok where there is no value, such as an equilibrium that is not reached: the solver then
  /// shortens its step.
  virtual Status Evaluate(const Eigen::VectorXd& variables, LeastSquaresPoint* point) = 0;
  /// The point of the last Evaluate is the new iterate.
  virtual void Accept() {}
};

}  // namespace palpate::calibration
