// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "components/force_estimation/config.hpp"
#include "components/force_estimation/contact_site.hpp"
#include "components/force_estimation/marker_fitter.hpp"
#include "components/force_estimation/marker_frame.hpp"
#include "libs/core/status.hpp"
#include "libs/fem/time_budget.hpp"
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
  Eigen::VectorXd marker_residual_m;  ///< [3m] observed - model; 0 where a marker was not seen
  Eigen::VectorXd x_m;                ///< [3n] nodes of the model in equilibrium with the forces
  std::vector<robot::CableState> cables;
};

/// External forces from marker displacements: the QP of eqs. (11) to (14) with the cable inputs
/// imposed as forces (13) or displacements (14), relinearised until the model is in equilibrium.
/// Frames are taken one after the other; the state goes on from one to the next. Frames with a
/// reference shape only set the marker offsets (a tare) and give kNoCalibration.
class MarkerForceEstimator {
 public:
  /// `model` must outlive the estimator. `youngs_modulus_relative_sigma` of the calibration enters
  /// the intervals. Throws InputError where a robot without markers is given, or a site lies far
  /// from the body. `clock`: by which frame_budget_s is counted.
  MarkerForceEstimator(robot::RobotModel& model, const Config& config,
                       double youngs_modulus_relative_sigma = 0.0,
                       fem::SecondsClock clock = fem::SteadySeconds);
  ~MarkerForceEstimator();

  /// The estimate stays valid until the next call. With given contact sites nothing is allocated
  /// after the first frame, as long as none needs a restoration (marker_fitter.hpp).
  const ForceEstimate& Update(const MarkerFrame& frame);

  /// The given contact sites; empty where contacts are searched.
  const std::vector<ContactSite>& sites() const;
  /// The last converged state of given contacts, kept apart from frames that failed.
  const ModelState& last_good() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace palpate::force_estimation
