// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/joint/fit_check.hpp"

#include <algorithm>
#include <cmath>

#include "components/calibration/joint/solved_state.hpp"
#include "components/calibration/model_tolerance.hpp"
#include "libs/core/index.hpp"

namespace palpate::calibration {

namespace {

/// Larger values accept worse fits. One exchanged pair of labels exceeds ModelTolerance tenfold.
struct FitCheckFitCheckTuning {
  double most_chi_squared = 9.0;  ///< over its degrees of freedom: three standard deviations
  /// Of a pose with six degrees of freedom: exceeded by chance once in a million.
  double most_pose_chi_squared = 38.0;
};
constexpr FitCheckFitCheckTuning kFitCheckTuning;

/// Adds one frame's markers; returns their expected squares, m^2.
double AddFrame(const robot::RobotModel& model, const CalibrationFrame& frame,
                const Eigen::VectorXd& x_m, const Eigen::Matrix3Xd& residual_m, FitCheck* check) {
  const double extent_m = ExtentOf(model.RestState().x_m);
  double expected_m2 = 0.0;
  for (std::size_t k = 0; k < frame.markers.size(); ++k) {
    const MarkerSighting& sighting = frame.markers[k];
    const auto& point = model.body().markers.at(At(sighting.marker)).point;
    const double motion_m = (point.weights.Position(x_m) - point.rest_m).norm();
    // Equal in all directions, so that the sighting's frame does not matter.
    const double variance_m2 =
        sighting.covariance_m2.trace() / 3.0 + ModelVariance_m2(extent_m, motion_m);
    check->chi_squared += residual_m.col(ToIndex(k)).squaredNorm() / variance_m2;
    expected_m2 += 3.0 * variance_m2;
  }
  return expected_m2;
}

}  // namespace

FitCheck CheckFit(const robot::RobotModel& model, const std::vector<CalibrationFrame>& frames,
                  const JointCalibration& fit) {
  FitCheck check;
  double expected_m2 = 0.0;
  double squares_m2 = 0.0;
  double markers = 0.0;
  check.possible = true;
  for (std::size_t f = 0; f < frames.size(); ++f) {
    const double others = check.chi_squared;
    expected_m2 += AddFrame(model, frames[f], fit.x_m[f], fit.marker_residuals_m[f], &check);
    const auto seen = static_cast<double>(frames[f].markers.size());
    markers += seen;
    squares_m2 += fit.marker_residuals_m[f].squaredNorm();
    // A robust loss lets a fit pass by one frame that is unlike the others.
    if (check.chi_squared - others > kFitCheckTuning.most_chi_squared * 3.0 * seen) {
      check.possible = false;
    }
  }
  check.expected_rms_m = std::sqrt(expected_m2 / std::max(1.0, markers));
  check.residual_rms_m = std::sqrt(squares_m2 / std::max(1.0, markers));
  // Points of a surface in the same fit are no measure of its markers.
  check.degrees_of_freedom = std::min(fit.degrees_of_freedom, static_cast<int>(3.0 * markers));
  for (const AdjustedPose& pose : fit.adjusted_poses) {
    if (pose.chi_squared > kFitCheckTuning.most_pose_chi_squared) check.moved_poses.push_back(pose);
  }
  if (check.chi_squared >
      kFitCheckTuning.most_chi_squared * std::max(1, check.degrees_of_freedom)) {
    check.possible = false;
  }
  return check;
}

}  // namespace palpate::calibration
