// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "libs/core/status.hpp"
#include "libs/fem/interpolation_weights.hpp"
#include "libs/robot/observation_row.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::force_estimation {

/// Derivative of rows to forces anywhere on the body, about one shape. As the stiffness K is
/// symmetric, a substitution for each row serves all places. Cables at imposed
/// displacement hold their length, slack ones stay slack (eq. (14) solved for the cables, as
/// ActuatorCondensation does).
class ObservationJacobian {
 public:
  /// Appends `rows`, about the same shape `x_m` [3n], with the factor
  /// that `model` has there. kUnobservable where the cable Jacobian is rank deficient (two taut
  /// cables are collinear), kInvalidInput where a response is not finite: then none of `rows` is
  /// appended.
  Status Add(robot::RobotModel& model, const std::vector<robot::ObservationRow>& rows,
             const Eigen::VectorXd& x_m, const std::vector<robot::ActuatorCommand>& commands,
             const Eigen::VectorXd& lambda_a_N);
  void Clear();
  int Count() const { return static_cast<int>(columns_.cols()); }

  /// Another number after each change.
  int version() const { return version_; }

  /// [rows x 3] response to unit forces along x, y and z on these nodes, m/N.
  Eigen::MatrixX3d To(const fem::InterpolationWeights& place) const;

 private:
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  RowMajor columns_;             ///< [reduced x rows] K^-1 of each row
  std::vector<int> free_index_;  ///< [nodes]; -1: fixed
  int version_ = 0;
};

}  // namespace palpate::force_estimation
