// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <stop_token>
#include <vector>

#include "components/calibration/cloud/skin_in_view.hpp"
#include "libs/geometry/rigid_transform.hpp"
#include "libs/rgbd/sensed_cloud.hpp"

namespace palpate::calibration {

/// Points of a cloud, [n] each, camera frame.
struct ThinCloud {
  Eigen::Matrix3Xd points_m;
  Eigen::VectorXd sigma_m;  ///< of z

  Eigen::Index Count() const { return points_m.cols(); }
};

/// One point for each cell of a grid over the picture whose cells are `spacing_m` wide at the
/// cloud's median distance: the one nearest to the cell's middle, so that noise of the depth has no
/// part in the choice. Points must be finite and before the camera.
ThinCloud Thin(const rgbd::SensedCloud& cloud, double spacing_m);

struct PoseSearchSettings {
  /// How far from the skin a point may lie and still pull a quarter as hard, m: first and last. It
  /// shrinks by `shrink` once the pose comes to rest.
  double widest_m = 0.03;
  double narrowest_m = 0.003;
  double shrink = 0.7;
  int steps_each = 6;         ///< at most, at each width
  double at_rest_m = 0.5e-3;  ///< a step that moves the cloud's points less than this is rest
  double near_m = 0.012;      ///< place of the skin to a point: covered; more than their spacing
  /// Where the search from the start covers less of the skin than `good_cover`, it begins again
  /// from starts turned and shifted by so much; of those that end near the start the one
  /// that covers most counts.
  double good_cover = 0.85;
  double around_rad = 0.26;
  double around_m = 0.03;
  /// A pose that turns the cloud, or shifts its middle, farther from the start than this is not
  /// the one that was meant: a robot that looks the same after a quarter turn fits there as well.
  double farthest_rad = 0.7;
  double farthest_m = 0.1;
  std::stop_token stop = {};  ///< ends the search where it is
};

/// What a pose says of the clouds.
struct PoseFit {
  geometry::RigidTransform T_robot_camera;
  double skin_covered = 0.0;  ///< share of the skin that should be seen and has points near it
  int starts = 0;             ///< that were tried
};

/// Camera pose for skins whose shapes are given, frame by frame, by robust point-to-plane
/// registration (Chen and Medioni 1992) with a Geman-McClure kernel that narrows (graduated
/// non-convexity, as Zhou, Park and Koltun 2016). Points pull towards the skin that the camera
/// sees from where it is thought to be, and places of that skin pull the points nearest to them.
PoseFit SearchPose(std::vector<SkinInView>& skins, const std::vector<ThinCloud>& clouds,
                   const geometry::RigidTransform& T_robot_camera_start,
                   const PoseSearchSettings& settings);

/// Whether a pose is as near to the start as `settings` ask for.
bool IsNear(const geometry::RigidTransform& T_robot_camera, const geometry::RigidTransform& start,
            const std::vector<ThinCloud>& clouds, const PoseSearchSettings& settings);

/// Share of the skin in view that has a point within `near_m`.
double ShareCovered(const SkinInView& skin, const ThinCloud& cloud,
                    const geometry::RigidTransform& T_robot_camera, double near_m);

}  // namespace palpate::calibration
