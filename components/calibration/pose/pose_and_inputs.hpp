// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <string_view>
#include <vector>

#include "components/calibration/marker_sighting.hpp"
#include "libs/core/status.hpp"
#include "libs/fem/static_solver.hpp"
#include "libs/geometry/rigid_transform.hpp"

namespace palpate::calibration {

/// Outcome of a calibration of camera pose and cable inputs.
enum class PoseFinding {
  kNotRun,
  kSolved,
  kZeroMotion,         ///< solved; no input differs from zero by more than its error
  kNotConverged,       ///< iterations used up
  kFailedEquilibrium,  ///< the model has no equilibrium under the inputs on the way
  kDegenerateMarkers,  ///< fewer than 3, coincident or collinear: no pose
  kMirroredMarkers,    ///< assigned to mirror images
  kUnknownInputs,      ///< the markers do not determine an input, see the message
  kWrongRobot,         ///< the residual is far above the noise
  kInvalidInput,       ///< NaN, unknown or duplicate marker, limits that cross
};

/// The word for `finding` in files and messages, e.g. "solved", "mirrored_markers".
std::string_view ToString(PoseFinding finding);

/// Pose, inputs and shape. The pose is identity and the inputs are zero where the status is not ok,
/// except for kNotConverged: there they are those of the last iteration.
struct PoseAndInputs {
  PoseFinding finding = PoseFinding::kNotRun;
  Status status;  ///< ok: solved or zero motion
  geometry::RigidTransform T_robot_camera;
  Eigen::VectorXd lambda_a_N;      ///< [a] tensions
  Eigen::VectorXd displacement_m;  ///< [a] of the cables, pulled in from the undeformed body on
  fem::StaticState state;          ///< equilibrium under lambda_a_N

  /// Of (theta rad, tau m, lambda_a N) jointly [6 + a]; theta and tau along the robot's axes about
  /// T_robot_camera (geometry::Registration). From the sightings' covariances, to first order.
  /// Limits are ignored: an input at a limit has a smaller error.
  Eigen::MatrixXd covariance;
  Eigen::VectorXd standard_error_N;  ///< [a]

  Eigen::Matrix3Xd residual_m;  ///< [3 x sightings] R p_camera + T - p_model, robot frame
  double residual_rms_m = 0.0;  ///< of their lengths
  double chi_squared = 0.0;
  int degrees_of_freedom = 0;  ///< 3n - 6 - a

  /// RMS of the residual after each inner iteration: the paper's Fig. 6.
  std::vector<double> residual_rms_after_m;
  int outer_iterations = 0;
  int tangents = 0;  ///< linearisations
  /// Number of steps (6) that failed and were replaced by a load continuation.
  int continuation_steps = 0;
  /// Expected change of the inputs by all further outer iterations, N (linear convergence).
  double remaining_change_N = 0.0;
};

}  // namespace palpate::calibration
