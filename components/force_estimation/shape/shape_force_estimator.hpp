// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "components/force_estimation/config.hpp"
#include "components/force_estimation/marker_force_estimator.hpp"
#include "components/force_estimation/shape/shape_config.hpp"
#include "components/force_estimation/shape/shape_frame.hpp"
#include "components/force_estimation/shape/surface_matching.hpp"
#include "libs/geometry/depth_bias_map.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::force_estimation {

/// A feature point in the last frame.
struct FeatureReport {
  correspondence::MatchState state = correspondence::MatchState::kHidden;
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  ///< on the model, robot frame
  double residual_m = 0.0;  ///< cloud - model along the normal, after the fit; 0 where not matched
  double sigma_m = 0.0;     ///< expected of it
};

/// External forces from the robot's shape as a depth camera sees it (sections V.A.4 to V.B of the
/// paper, and beyond it): features matched along their normals, the QP (10) to (14) iterated to
/// equilibrium, contacts that were seen moved along the surface as far as the deformation asks for
/// within their covariance, contacts that nobody saw searched for.
///
/// The first frames with `untouched` teach the depth bias and give kNoCalibration. A frame of which
/// too little matches gives kNoRobotSeen; its x_m says where the robot would be, so that perception
/// finds it.
class ShapeForceEstimator {
 public:
  /// `model` must outlive the estimator. Of `config` these count: significance,
  /// unobservable_sigma_N, max_contacts, max_iterations, frame_tolerance, frame_budget_s,
  /// contact_marker_weight. Throws InputError where the robot has no feature points.
  ShapeForceEstimator(robot::RobotModel& model, const Config& config, const ShapeConfig& shape,
                      double youngs_modulus_relative_sigma = 0.0);
  ~ShapeForceEstimator();

  /// What calibration found of the depth image, together with this pose of the camera, which frames
  /// will give: frames without contact then teach the rest of it, and none are needed. Before the
  /// first frame.
  void TakeDepthBias(const geometry::DepthBiasMap& map, const Eigen::Isometry3d& T_robot_camera);

  /// The estimate stays valid until the next call. Contacts that were seen have their names and
  /// kOk, kTangentialUnobservable or kUnobservable; those found by search are called hidden_1,
  /// hidden_2 and have kHidden.
  const ForceEstimate& Update(const ShapeFrame& frame);

  /// To be called after each Update, once its estimate is out: a factor and responses at the shape
  /// that was found, where the next frame will want them. The estimate and the features stay.
  void PrepareNext();

  const std::vector<FeatureReport>& features() const;  ///< of the last frame
  /// Smallest force that a contact at this place of the undeformed body could have and be found, N
  /// (normal direction, Config::significance); NaN before the bias is known, and where the model
  /// has no factor.
  double SmallestForce_N(const Eigen::Vector3d& rest_position_m) const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

/// Whether x_m of this estimate may be shown to perception as the robot's predicted shape.
bool PredictsShape(const ForceEstimate& estimate);

}  // namespace palpate::force_estimation
