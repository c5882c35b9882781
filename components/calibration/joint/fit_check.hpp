// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <vector>

#include "components/calibration/joint/joint_calibration.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::calibration {

/// How far markers are from a fitted model, over how far noise and a sound robot's tolerances may
/// put them.
struct FitCheck {
  bool possible = false;
  double chi_squared = 0.0;  ///< of noise and tolerances together
  int degrees_of_freedom = 0;
  double residual_rms_m = 0.0;
  double expected_rms_m = 0.0;  ///< of noise and tolerances
  /// Poses that the fit moved by far more than their standard errors.
  std::vector<AdjustedPose> moved_poses = {};
};

/// Compares the markers' residuals of `fit` with the covariances of the sightings, the placement of
/// markers (a share of the body's extent) and the model's error (a share of each marker's motion):
/// of each frame, and of all.
/// A fit without markers is possible.
FitCheck CheckFit(const robot::RobotModel& model, const std::vector<CalibrationFrame>& frames,
                  const JointCalibration& fit);

}  // namespace palpate::calibration
