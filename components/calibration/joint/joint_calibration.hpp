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
  /// A number is undetermined where the data leave it more uncertain than this share of what was
  /// believed, or is plausible, before.
  double undetermined_share = 0.5;
};

/// A number that was looked for.
struct FittedValue {
  std::string name;
  std::string unit;
  double value = 0.0;
  double standard_error = 0.0;  ///< of a held one its belief's; infinite: nothing is known
  bool determined = false;      ///< else held at its belief's mean
  std::string what_would_tell;  ///< where it is undetermined: the recording that determines it
};

struct JointCalibration {
  Status status;
  geometry::RigidTransform T_robot_camera;
  /// Of PoseChange at the found pose (rad, m); 0 where the pose was given.
  Eigen::Matrix<double, 6, 6> pose_covariance = Eigen::Matrix<double, 6, 6>::Zero();
  std::vector<FittedValue> values;  ///< without the pose; unknowns in their order, last
  /// Where it was looked for; its covariance is that against this model (DepthBiasMap).
  std::optional<geometry::DepthBiasMap> depth_bias;
  Eigen::MatrixXd pose_and_bias_covariance;  ///< [6 + k square] likewise, against the truth
  /// [values] of their errors; 0 for held ones that nothing is known of.
  Eigen::MatrixXd correlation;
  double residual_rms_m = 0.0;  ///< of all frames
  std::vector<double> residual_rms_of_frame_m;
  std::vector<Eigen::VectorXd> x_m;  ///< [frames] equilibria, nodes [3n]
  double chi_squared = 0.0;
  int degrees_of_freedom = 0;
  std::vector<double> objectives;  ///< of the start and after each iteration
  /// Of all frames, at the start and after each iteration: the paper's Fig. 6.
  std::vector<double> residual_rms_after_m;
  int iterations = 0;
};

/// Finds pose and unknowns together (the paper's eqs. (7) to (9) without taking turns), by Ipopt,
/// equilibria to the static solver's tolerance. Standard errors come from the sightings' and the
/// beliefs' sigmas, widened where the residual exceeds them. Numbers that these data do not
/// determine are held where they were believed and named. The model is left with what was found; on
/// failure as it was: kUnobservable where the pose is not determined, kNotConverged, or why the
/// start has no equilibrium.
JointCalibration CalibrateJointly(robot::RobotModel& model, const JointSetup& setup,
                                  const JointSettings& settings = {});

}  // namespace palpate::calibration
