// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <random>
#include <vector>

#include "components/perception/observation.hpp"
#include "libs/rgbd/sensed_cloud.hpp"

namespace palpate::perception::test {

/// The robot is a plate z = 0 of its own frame, the objects are balls that lie on it or posts that
/// stand on it. Seen from everywhere at once, or by a camera.
struct BallsOnPlate {
  double radius_m = 0.015;
  double plate_half_m = 0.1;
  std::vector<Eigen::Vector2d> touch_m;  ///< where each ball touches
  double gap_m = 0.0;                    ///< air under the balls, or posts
  double post_height_m = 0.0;            ///< > 0: posts instead of balls (for Look)
};

struct Clouds {
  rgbd::SensedCloud robot;
  rgbd::SensedCloud object;
};

/// All of the plate and of the balls' lower halves, points about `spacing_m` apart, in a camera
/// frame whose origin lies `distance_m` above the plate's middle (plate frame turned about x by
/// pi).
Clouds SampleAll(const BallsOnPlate& scene, double spacing_m, double distance_m = 0.45);

/// What a camera sees that looks at the plate's middle from `distance_m`, its axis `tilt_rad` off
/// the plate's normal (about x) after a turn by `turn_rad` about the normal; rays `spacing_m` apart
/// at that distance, each with Gaussian noise of z of `sigma_m`. `touch_camera_m`: where the balls
/// touch, in the camera frame.
struct ContactView {
  double distance_m = 0.45;
  double tilt_rad = 1.0;
  double turn_rad = 0.0;
  double spacing_m = 0.0014;
  double sigma_m = 3e-4;
};
Clouds Look(const BallsOnPlate& scene, const ContactView& view, std::mt19937* random,
            std::vector<Eigen::Vector3d>* touch_camera_m);

/// The plate as a predicted surface in that camera's frame, its underside too.
PredictedSurface PlateSeenBy(const ContactView& view, double plate_half_m);

/// `points_m` with the same sigma each.
rgbd::SensedCloud CloudOf(const std::vector<Eigen::Vector3d>& points_m, double sigma_m);

}  // namespace palpate::perception::test
