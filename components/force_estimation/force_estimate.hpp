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
  /// kOk, kUncertain (acts, but ci95_N is large beside |F|), kTangentialUnobservable (force along
  /// the normal only), kHidden, kUnobservable, kNoContact.
  Status status;
  std::string name;
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  ///< on the deformed body, robot frame
  Eigen::Vector3d force_N = Eigen::Vector3d::Zero();     ///< acts on the robot, robot frame
  /// Robot frame. Along tangents that the data do not determine it has the prior's variance, by
  /// friction; across a direction that was given it is zero; NaN where kUnobservable.
  Eigen::Matrix3d covariance_N2 = Eigen::Matrix3d::Zero();
  /// Half-width of the 95 % interval of |F|, from covariance_N2. From markers with
  /// kTangentialUnobservable: of the component along force_N.
  double ci95_N = 0.0;
  double location_ci95_m = 0.0;  ///< 0 where the site was given
  /// Of position_m along the surface, robot frame; zero where the site was given.
  Eigen::Matrix3d location_covariance_m2 = Eigen::Matrix3d::Zero();
};

/// The forces of one frame.
struct ForceEstimate {
  /// kOk: `contacts` may be used. kNoContact: the deformation is explained without a force.
  /// kUnobservable, with contacts: the markers determine none of the forces; without: the shape
  /// shows that something pushes, and not where or how hard. kBudgetReached: not
  /// converged within frame_budget_s or max_iterations; the next frame continues.
  Status status;
  double t_s = 0.0;
  std::vector<ContactForce> contacts;
  int iterations = 0;           ///< linearisations
  double frame_error = 0.0;     ///< relative, compared with Config::frame_tolerance
  double residual_rms_m = 0.0;  ///< of the observed rows, after the fit
  double noise_rms_m = 0.0;     ///< expected of residual_rms_m from the noise
  double chi_squared = 0.0;     ///< weighted residual
  int degrees_of_freedom = 0;
  /// [3m] measured - model, robot frame; 0 where a marker was not measured. Empty for an estimate
  /// from the robot's shape.
  Eigen::VectorXd marker_residual_m;
  Eigen::VectorXd x_m;  ///< [3n] nodes in equilibrium with the forces, robot frame
  std::vector<robot::ActuatorState> cables;
};

/// Whether an estimate of this status may be used: forces were found, or none act.
bool IsUsable(const Status& status);

/// Half-width h of the 95 % confidence interval |F| +- h of the size of a force, N, where `force_N`
/// is an estimate with the covariance `covariance_N2`. Of a force that is large beside it, 1.96
/// standard deviations along the force. Of a small one |F| is no linear function and is estimated
/// too large: Neyman's interval then, over a fixed quasi-random sample; its longer side counts.
double HalfWidth95_N(const Eigen::Vector3d& force_N, const Eigen::Matrix3d& covariance_N2);
/// The same of the component along `force_N`, which must not be zero: 1.96 standard deviations.
double HalfWidthAlong95_N(const Eigen::Vector3d& force_N, const Eigen::Matrix3d& covariance_N2);

/// Sets ci95_N of a force from markers by its covariance: of the component along the normal where
/// that alone is known well, else of |F|. Friction that the markers do not determine may change the
/// normal component, too. Above the share `uncertain_share` of |F| the force is kUncertain.
void SetInterval(double uncertain_share, ContactForce* contact);

}  // namespace palpate::force_estimation
