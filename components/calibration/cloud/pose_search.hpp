// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <stop_token>
#include <vector>

#include "components/calibration/cloud/surface_in_view.hpp"
#include "libs/geometry/rigid_transform.hpp"
#include "libs/rgbd/sensed_cloud.hpp"

namespace palpate::calibration {

/// Points of a cloud, [n] each, camera frame.
struct ThinCloud {
  Eigen::Matrix3Xd points_m;
  Eigen::VectorXd sigma_m;  ///< of z

  Eigen::Index Count() const { return points_m.cols(); }
};

/// One point for each cell of an image grid that is `spacing_m` wide at the cloud's median
/// distance: the one nearest to the cell's centre, so that the choice does not depend on depth
/// noise. Points must be finite and in front of the camera.
ThinCloud Thin(const rgbd::SensedCloud& cloud, double spacing_m);

struct PoseSearchSettings {
  /// Width of the kernel, m, first and last: the distance at which a point has a quarter of the
  /// full weight. It shrinks by `shrink` once the pose is at rest.
  double widest_m = 0.03;
  double narrowest_m = 0.003;
  double shrink = 0.7;
  int steps_each = 6;         ///< largest number at each width
  double at_rest_m = 0.5e-3;  ///< a smaller step ends a width
  double near_m = 0.012;      ///< distance at which surface is covered; above the spacing
  /// While the coverage is below `good_cover`, the search restarts from poses turned and shifted by
  /// these amounts. Of the results near the initial pose the one with the largest coverage counts.
  double good_cover = 0.85;
  double around_rad = 0.26;
  double around_m = 0.03;
  /// Largest turn and shift of the cloud's centroid from the initial pose. Beyond, a symmetric
  /// robot fits equally well.
  double farthest_rad = 0.7;
  double farthest_m = 0.1;
  std::stop_token stop = {};  ///< ends the search at its present pose
};

/// Result of a search.
struct PoseFit {
  geometry::RigidTransform T_robot_camera;
  double surface_covered = 0.0;  ///< share of the visible surface with points near it
  int starts = 0;                ///< number of initial poses
};

/// Camera pose for given shapes, one per frame, by robust point-to-plane registration (Chen and
/// Medioni 1992) with a Geman-McClure kernel that narrows (graduated non-convexity, as Zhou, Park
/// and Koltun 2016). Points are matched to the visible surface at the present pose, and surface
/// points to the cloud.
PoseFit SearchPose(std::vector<SurfaceInView>& surfaces, const std::vector<ThinCloud>& clouds,
                   const geometry::RigidTransform& T_robot_camera_start,
                   const PoseSearchSettings& settings);

/// Whether a pose is within farthest_rad and farthest_m of the initial one.
bool IsNear(const geometry::RigidTransform& T_robot_camera, const geometry::RigidTransform& start,
            const std::vector<ThinCloud>& clouds, const PoseSearchSettings& settings);

/// Coverage: share of the visible surface with a point within `near_m`.
double ShareCovered(const SurfaceInView& surface, const ThinCloud& cloud,
                    const geometry::RigidTransform& T_robot_camera, double near_m);

}  // namespace palpate::calibration
