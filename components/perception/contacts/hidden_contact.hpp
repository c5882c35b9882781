// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "components/perception/contacts/ball_fit.hpp"
#include "components/perception/contacts/surface_around.hpp"
#include "components/perception/observation.hpp"
#include "libs/rgbd/sensed_cloud.hpp"

namespace palpate::perception {

/// Contact of an object that is round next to the robot, behind its visible part.
struct HiddenContact {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance_m2 = Eigen::Matrix3d::Zero();
  double radius_m = 0.0;  ///< of the ball
  double gap_m = 0.0;     ///< from the object to the robot's surface; < 0: it dents the robot
  bool touches = false;   ///< false: the gap is larger than its uncertainty
};

/// Uncertainty of distances between the clouds.
struct Resolution {
  double noise_m = 0.0;       ///< sigma of a distance along the view ray
  double resolution_m = 0.0;  ///< with the spacing of the points

  /// Of a uniform distribution over the resolution.
  double Variance_m2() const { return resolution_m * resolution_m / 12.0; }
};

struct HiddenContactTuning {
  BallFitTuning ball = {};
  SurfaceAroundTuning around = {};
  /// Radii around the rim within which the object is fitted: a whole finger tip, then a smaller
  /// thing on a stem.
  std::array<double, 2> reaches_m = {0.02, 0.01};
  /// RMS residual of a ball, at most this many sigmas of noise and this share of the radius.
  /// Larger: other shapes count as balls.
  double noise_sigmas = 1.5;
  double out_of_round = 0.05;
  double largest_sigma = 0.3;  ///< of the centre, in radii; larger: caps that hardly bend
  /// Standard deviation of the points over the radius: half a ball as a camera sees it has 0.5.
  /// Smaller: a narrow strip of something else counts as part of a much larger ball.
  double least_covered = 0.25;
  /// Without a predicted surface: distance from the ball of the points of the plane below it, over
  /// which their weight falls, and their number. Larger: smoother planes, wrong on bent bodies.
  double plane_reach_m = 0.01;
  double plane_fade_m = 0.005;
  Eigen::Index fewest_below = 8;
  double normal_sigma_rad = 0.2;  ///< of that plane, which is occluded below the ball
  /// Of the predicted surface after its fit to the frame. Larger: balls that hover count as
  /// contacts.
  double surface_sigma_m = 1.2e-3;
  /// Of its shape over the width of a ball, where most of that error is common. Larger: wider
  /// contact locations.
  double shape_sigma_m = 0.6e-3;
  double farthest_sigmas = 5.0;  ///< of the shape; larger: slower; weights beyond are below 1e-5
  /// Gap between ball and surface that still touches, in sigmas. Larger: more false contacts.
  double gap_sigmas = 3.0;
  /// The same without a predicted surface, in resolutions of the clouds.
  double largest_gap = 1.5;
  double surface_reach_m = 0.02;  ///< around the ball, of the surface that is evaluated
  int touch_rounds = 4;           ///< Gauss-Newton; more: slower, a more exact optimum
};

/// Fits a ball to the object's points around `rim_m` (the mean of those next to the robot). The
/// contact is the point of `surface` nearest to the ball's centre, visible or not. The constraint
/// that the ball touches there makes it more certain than its visible cap alone. Without a surface
/// (nullptr) a plane fitted to the robot's points around the ball replaces it. Empty where the
/// object is not round there: an edge, a plate, the flank of a rod.
std::optional<HiddenContact> FindHiddenContact(const rgbd::SensedCloud& robot,
                                               const rgbd::SensedCloud& object,
                                               const Eigen::Vector3d& rim_m,
                                               const PredictedSurface* surface,
                                               const Resolution& known,
                                               const HiddenContactTuning& tuning = {});

/// The same for an object so large that it hides the robot near its visible part: fits the ball to
/// all its points [3 x n]. Empty where it is not round, or does not touch the surface within the
/// uncertainty of both.
std::optional<HiddenContact> FindContactUnder(const Eigen::Matrix3Xd& points_m,
                                              const PredictedSurface& surface, double noise_m,
                                              const HiddenContactTuning& tuning = {});

}  // namespace palpate::perception
