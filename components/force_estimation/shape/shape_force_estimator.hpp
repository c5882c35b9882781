// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "components/force_estimation/config.hpp"
#include "components/force_estimation/marker_force_estimator.hpp"
#include "components/force_estimation/shape/bias_frame_check.hpp"
#include "components/force_estimation/shape/shape_config.hpp"
#include "components/force_estimation/shape/shape_frame.hpp"
#include "components/force_estimation/shape/surface_matching.hpp"
#include "libs/geometry/depth_bias_map.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::force_estimation {

/// A surface point in the last frame, as the camera sees it that tells most of it.
struct FeatureReport {
  correspondence::MatchState state = correspondence::MatchState::kHidden;
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  ///< on the model, robot frame
  double residual_m = 0.0;  ///< cloud - model along the normal, after the fit; 0 where not matched
  double sigma_m = 0.0;     ///< expected of it
};

struct ShapeForceEstimatorTuning {
  Eigen::Index fewest_points = 50;  ///< of the robot cloud; fewer: shapes that the prior determines
  /// Mean square residual over its variance above which no force explains the shape. Larger: forces
  /// from a wrong camera pose; smaller: real deformations are refused.
  double worst_misfit = 30.0;
  /// Such frames in a row until the model restarts from the shape without contact. Fewer: one bad
  /// frame costs the contacts' history.
  int misfits_to_restart = 3;
  /// Frames in a row that a fit may take. More: a longer pursuit of a shape that is not the
  /// robot's.
  int most_frames_on_budget = 8;
  /// A gap of so many frame periods, and of this time, ends a sequence: contacts may have changed.
  /// Longer: contacts survive a change that was not seen; shorter: dropped frames restart.
  double gap_frames = 5.0;
  double least_gap_s = 0.5;
  /// At the start of a sequence: rounds of contact search, as long as the misfit falls to this
  /// share of the last one. More rounds: a longer first frame.
  int rounds_to_begin = 8;
  double falling_misfit = 0.95;
  /// Misfit below which a fit needs no alternative. Smaller: more alternatives are tried.
  double good_misfit = 2.0;
  /// Frames at the start of a sequence without a limit of work. More: a longer start, fewer
  /// sequences that begin with a wrong shape.
  int frames_to_begin = 3;
};

/// External forces from the robot's shape in depth images (sections V.A.4 to V.B of the paper, with
/// extensions): surface points matched along their normals, the QP (10) to (14) iterated to
/// equilibrium, visible contacts moved along the surface by the deformation within their
/// covariance, hidden contacts found by search.
///
/// The first frames with `untouched` serve to estimate the depth bias and give kNoCalibration.
/// Without such frames and without TakeDepthBias, the bias is fitted along with the forces of each
/// frame: intervals are wider, and hidden contacts are not searched. Where the bias of some cameras
/// is known, the others are not used. A camera that sees nothing in a frame costs accuracy only. A
/// frame with too few matches gives kNoRobotSeen; its x_m is the predicted shape for perception.
class ShapeForceEstimator {
 public:
  /// `model` must outlive the estimator. Of `config` these count: significance,
  /// unobservable_sigma_N, max_contacts, max_iterations, frame_tolerance, frame_budget_s,
  /// contact_marker_weight. Throws InputError where the robot has no feature points.
  ShapeForceEstimator(robot::RobotModel& model, const Config& config, const ShapeConfig& shape,
                      double youngs_modulus_relative_sigma = 0.0,
                      const ShapeForceEstimatorTuning& tuning = {});
  ~ShapeForceEstimator();

  /// The depth bias that a calibration has estimated together with this camera pose, which the
  /// frames' views of that number must have. Contact-free frames then refine it, and none are
  /// needed. Before the first frame.
  void TakeDepthBias(const geometry::DepthBiasMap& map, const Eigen::Isometry3d& T_robot_camera,
                     int camera = 0);

  /// The estimate stays valid until the next call. Visible contacts have their names and kOk,
  /// kUncertain or kTangentialUnobservable; hidden ones are called hidden_1, hidden_2 and have
  /// kHidden. A contact whose push the data do not determine, as on the clamp, is left out.
  const ForceEstimate& Update(const ShapeFrame& frame);

  /// Whether the frames with `untouched`, by epoch, were contact-free.
  std::vector<BiasSequence> JudgeBiasFrames() const;

  /// To be called after each Update, once its estimate is published: a factor and responses at the
  /// fitted shape, for the next frame. The estimate and the features stay.
  void PrepareNext();

  const std::vector<FeatureReport>& features() const;  ///< of the last frame
  /// Smallest force of a contact at this place of the undeformed body that is detectable, N (normal
  /// direction, Config::significance); NaN before the bias is known, and where the model has no
  /// factor.
  double SmallestForce_N(const Eigen::Vector3d& rest_position_m) const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

/// Whether x_m of this estimate may be sent to perception as the robot's predicted shape.
bool PredictsShape(const ForceEstimate& estimate);

}  // namespace palpate::force_estimation
