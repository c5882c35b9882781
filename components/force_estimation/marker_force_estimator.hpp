// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "components/force_estimation/config.hpp"
#include "components/force_estimation/contact_site.hpp"
#include "components/force_estimation/fit/force_fitter.hpp"
#include "components/force_estimation/force_estimate.hpp"
#include "components/force_estimation/marker_frame.hpp"
#include "libs/core/status.hpp"
#include "libs/fem/time_budget.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::force_estimation {

/// What a frame's fit left of the markers, for whoever asks what else explains it.
struct MarkerMisfit {
  Eigen::VectorXd residual_m;  ///< [3m] observed - model; 0 where a marker was not used
  Eigen::VectorXd weight;      ///< [3m] 1/m^2; 0: not used
  Eigen::MatrixXd response_m;  ///< [3m x 3k] to the contacts' forces, per N, under the cable inputs
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
  /// after the first frame, as long as none needs a restoration (fit/force_fitter.hpp).
  const ForceEstimate& Update(const MarkerFrame& frame);

  /// Of the last frame; nothing (weights 0) where no fit of it stands.
  MarkerMisfit Misfit();

  /// The given contact sites; empty where contacts are searched.
  const std::vector<ContactSite>& sites() const;
  /// The last converged state of given contacts, kept apart from frames that failed.
  const ModelState& last_good() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace palpate::force_estimation
