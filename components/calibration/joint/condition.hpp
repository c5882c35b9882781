// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "libs/fem/interpolation_weights.hpp"
#include "libs/robot/robot_model.hpp"
#include "libs/robot/sensitivity/sensitivity_solver.hpp"

namespace palpate::calibration {

/// Constraint on the equilibrium of one frame, beyond bounds on unknowns.
class Condition {
 public:
  Condition(int frame, double lower, double upper) : frame_(frame), lower_(lower), upper_(upper) {}
  virtual ~Condition() = default;

  int frame() const { return frame_; }
  double lower() const { return lower_; }
  double upper() const { return upper_; }

  virtual double Value(const robot::RobotModel& model, const fem::StaticState& state) const = 0;
  /// [parameters of `sensitivity`]
  virtual Eigen::RowVectorXd Derivative(const robot::SensitivitySolver& sensitivity) const = 0;

 private:
  int frame_;
  double lower_;
  double upper_;
};

using ConditionPtr = std::unique_ptr<const Condition>;

/// The sum of shares[c] times the displacement (m, pulled in) of cable c lies within the bounds, as
/// where one drum winds up a cable and lets out another. In units of 1 mm.
ConditionPtr CableLengths(int frame, std::vector<double> shares, double lower_m, double upper_m);

/// A point of the body stays at least `distance_m` beyond the plane through `plane_point_m` with
/// the unit `normal` (robot frame), such as a table. In units of 1 mm.
ConditionPtr StaysBeyondPlane(int frame, fem::InterpolationWeights point,
                              const Eigen::Vector3d& plane_point_m, const Eigen::Vector3d& normal,
                              double distance_m = 0.0);

}  // namespace palpate::calibration
