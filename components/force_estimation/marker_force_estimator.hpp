// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "components/force_estimation/config.hpp"
#include "components/force_estimation/contact_site.hpp"
#include "components/force_estimation/fit/force_newton.hpp"
#include "components/force_estimation/force_estimate.hpp"
#include "components/force_estimation/marker_frame.hpp"
#include "libs/core/status.hpp"
#include "libs/fem/time_budget.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::force_estimation {

/// Residual of a frame's fit, and what contact forces could make of it.
struct MarkerMisfit {
  Eigen::VectorXd residual_m;  ///< [3m] measured - model; 0 where a marker was not used
  Eigen::VectorXd weight;      ///< [3m] 1/m^2; 0: not used
  /// [3m x 3k] displacement of the markers for each newton of the contact forces, under the cable
  /// inputs, m/N.
  Eigen::MatrixXd response_m;
};

/// External forces from marker positions: the QP of eqs. (11) to (14) of the paper with prescribed
/// cable tensions (13) or displacements (14), relinearised until the model is in equilibrium. Each
/// frame starts at the state of the one before. Frames with a reference shape only set the marker
/// offsets and give kNoCalibration. Without given contacts the known loads of a frame
/// (MarkerFrame::loads) are its contacts, and where there are none, contacts are searched.
/// An error of the pose widens the intervals, as one that all markers share; what it may explain is
/// no contact.
class MarkerForceEstimator {
 public:
  /// `model` must outlive the estimator. `youngs_modulus_relative_sigma`: relative standard error
  /// of the modulus, which widens the intervals. `clock`: of frame_budget_s. Throws InputError for
  /// a robot without markers, too many given contacts, and one far from the body's surface.
  MarkerForceEstimator(robot::RobotModel& model, const Config& config,
                       double youngs_modulus_relative_sigma = 0.0,
                       fem::SecondsClock clock = fem::SteadySeconds);
  ~MarkerForceEstimator();

  /// The estimate stays valid until the next call. With given contact sites nothing is allocated
  /// after the first frame, unless one needs a continuation step (fit/force_newton.hpp) or the pose
  /// has an error.
  const ForceEstimate& Update(const MarkerFrame& frame);

  /// Of the last frame; weights of 0 where its fit failed.
  MarkerMisfit Misfit();

  /// The given contact sites, or known loads of the last frame; empty where contacts are searched.
  const std::vector<ContactSite>& sites() const;
  /// The last converged state of given contacts; later frames that failed do not change it.
  const ModelState& last_good() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace palpate::force_estimation
