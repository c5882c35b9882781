// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "libs/core/status.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::force_estimation {

struct ContactForce {
  Status status;  ///< kOk, kTangentialUnobservable (force along the normal only), kUnobservable
  std::string name;
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  ///< on the deformed body, robot frame
  Eigen::Vector3d force_N = Eigen::Vector3d::Zero();     ///< acts on the robot, robot frame
  Eigen::Matrix3d covariance_N2 = Eigen::Matrix3d::Zero();
  double ci95_N = 0.0;           ///< half-width of the 95 % interval on |F|
  double location_ci95_m = 0.0;  ///< 0 where the site was given
};

/// The forces of one frame. Only where status is kOk may `contacts` be used; kNoContact says that
/// the deformation is explained without any; kUnobservable, with contacts, that the markers tell
/// none of the forces. kBudgetReached: not converged within frame_budget_s or max_iterations; the
/// next frame goes on from there.
struct ForceEstimate {
  Status status;
  double t_s = 0.0;
  std::vector<ContactForce> contacts;
  int iterations = 0;           ///< linearisations
  double frame_error = 0.0;     ///< relative, compared with Config::frame_tolerance
  double residual_rms_m = 0.0;  ///< of the markers, after the fit
  double noise_rms_m = 0.0;     ///< expected of it
  double chi_squared = 0.0;     ///< weighted residual
  int degrees_of_freedom = 0;
  Eigen::VectorXd marker_residual_m;  ///< [3m] observed - model; 0 where a marker was not seen;
                                      ///< empty where the robot's shape was observed instead
  Eigen::VectorXd x_m;                ///< [3n] nodes of the model in equilibrium with the forces
  std::vector<robot::CableState> cables;
};

/// Whether an estimate of this status may be used: forces were found, or none act.
bool IsUsable(const Status& status);

/// Standard deviation of |F|: along the force, and where there is none in the worst direction, N.
double SigmaOfSize_N(const Eigen::Vector3d& force_N, const Eigen::Matrix3d& covariance_N2);

}  // namespace palpate::force_estimation
