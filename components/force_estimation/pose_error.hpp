// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>

#include "libs/experiment/experiment.hpp"
#include "libs/robot/calibration_file.hpp"

namespace palpate::force_estimation {

/// Standard errors of the pose T_robot_measurement of markers: one error that all markers of all
/// frames share. The default is that of a pose that is exact, as in a simulation.
struct PoseError {
  Eigen::Vector3d about_m = Eigen::Vector3d::Zero();  ///< point that turns stay at, robot frame
  double translation_sigma_m = 0.0;                   ///< of that point, along each axis
  double rotation_sigma_rad = 0.0;                    ///< about each axis

  bool IsZero() const { return translation_sigma_m == 0.0 && rotation_sigma_rad == 0.0; }
  bool operator==(const PoseError&) const = default;
};

/// Of a recording whose markers are in the camera frame: the standard error that is stated for its
/// pose, about the camera (experiment::PoseErrorOf). Zero for `frame: robot`, and without a pose.
PoseError StatedPoseError(const experiment::Experiment& experiment,
                          const experiment::Recording& recording);

/// Of a calibrated pose, about the middle `middle_m` of what it was calibrated with (robot frame,
/// m). A fit determines where that middle is and, independently, how the camera is turned about it.
/// The error of the camera's own place is the sum of both, so that of the middle is what the turn
/// leaves of it.
PoseError CalibratedPoseError(const robot::CalibratedPose& pose, const Eigen::Vector3d& middle_m);

/// Derivatives of points [3 x m], robot frame, m, to the six errors over their sigmas [3m x 6], m.
/// `from_m` [3 x m]: points that count as displacements from there, which only turns change; a
/// column of NaN: that point counts as a position.
Eigen::MatrixXd PoseErrorColumns(const PoseError& error, const Eigen::Matrix3Xd& points_m,
                                 const Eigen::Matrix3Xd& from_m);

}  // namespace palpate::force_estimation
