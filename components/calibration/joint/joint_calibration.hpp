// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "components/calibration/joint/ipopt_solver.hpp"
#include "components/calibration/joint/joint_problem.hpp"
#include "libs/core/status.hpp"
#include "libs/geometry/depth_bias_map.hpp"
#include "libs/geometry/rigid_transform.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::calibration {

struct JointSettings {
  LeastSquaresSettings solver;
  /// A parameter is undetermined where its posterior standard deviation exceeds this share of its
  /// prior standard deviation, or of its plausible change.
  double undetermined_share = 0.5;
};

/// An estimated parameter.
struct FittedValue {
  std::string name;
  std::string unit;
  double value = 0.0;
  double prior_mean = 0.0;
  double standard_error = 0.0;  ///< of a held one that of its prior; infinite: none
  bool determined = false;      ///< otherwise held at its prior mean
  /// Of a held one: the standard error that the data leave, and the largest that determines it.
  double reached_error = 0.0;
  double error_limit = 0.0;
  std::string what_would_tell;  ///< the recording that would determine it; determined: empty
};

/// What is estimated of a camera.
struct FittedCamera {
  geometry::RigidTransform T_robot_camera;
  /// Of PoseChange at the estimated pose (rad, m); 0 where the pose was given.
  Eigen::Matrix<double, 6, 6> pose_covariance = Eigen::Matrix<double, 6, 6>::Zero();
  /// Where it was estimated; its covariance is that against this model (DepthBiasMap).
  std::optional<geometry::DepthBiasMap> depth_bias = {};
  Eigen::MatrixXd pose_and_bias_covariance = {};  ///< [6 + k square] the same against the truth
};

/// Of the robot and the first camera.
struct JointCalibration : FittedCamera {
  Status status;
  std::vector<FittedCamera> further_cameras;  ///< [JointSetup::further_cameras]
  std::vector<AdjustedPose> adjusted_poses;  ///< those with a prior, that of the first camera first
  std::vector<FittedValue> values;           ///< without the poses; unknowns in their order, last
  /// [values] of their errors; 0 for held ones without a prior.
  Eigen::MatrixXd correlation;
  double residual_rms_m = 0.0;  ///< of all frames
  std::vector<double> residual_rms_of_frame_m;
  std::vector<Eigen::Matrix3Xd> marker_residuals_m;  ///< [frames] of [3 x markers], robot frame
  std::vector<Eigen::VectorXd> x_m;                  ///< [frames] equilibria, nodes [3n]
  double chi_squared = 0.0;
  int degrees_of_freedom = 0;
  std::vector<double> objectives;  ///< at the start and after each iteration
  /// Of all frames, at the start and after each iteration: the paper's Fig. 6.
  std::vector<double> residual_rms_after_m;
  int iterations = 0;
};

/// Estimates pose and unknowns together (eqs. (7) to (9) of the paper without alternation), all
/// equilibria to the static solver's tolerance: docs/theory/calibration.md. Standard errors follow
/// from sightings and priors and carry Birge's ratio. Undetermined parameters are held at their
/// prior means and named. On success the model has the estimates, on failure it is unchanged:
/// kUnobservable (the pose is not determined), kNotConverged, or the status of the equilibrium at
/// the start.
JointCalibration CalibrateJointly(robot::RobotModel& model, const JointSetup& setup,
                                  const JointSettings& settings = {});

}  // namespace palpate::calibration
