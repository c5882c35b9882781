// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <vector>

#include "components/calibration/cloud/cloud_frame.hpp"
#include "components/calibration/cloud/pose_search.hpp"
#include "components/calibration/cloud/skin_errors.hpp"
#include "components/calibration/joint/joint_calibration.hpp"
#include "components/calibration/joint/joint_request.hpp"

namespace palpate::calibration {

struct CloudSettings {
  /// What is looked for beside the pose: offsets of the drives, unless told otherwise. What it says
  /// of markers and whether the pose is fitted has no meaning here.
  JointRequest request;
  double huber_threshold = 2.0;  ///< sigmas; in place of the request's
  /// Smooth error of the depth image, one sigma of each coefficient as a share of z
  /// (geometry::DepthBiasMap): what of it is not looked for, and what the clouds do not tell, stays
  /// at 0 and counts in the standard errors. 0: it has none.
  double depth_bias_sigma = 0.003;
  geometry::DepthBiasBasis depth_bias = {};
  bool fit_depth_bias = true;  ///< look for it
  SkinErrorSettings skin_errors;
  PoseSearchSettings search;
  /// Distance of neighbouring points that are used, m: of the search, and of the joint fit. Depth
  /// noise is alike in neighbouring pixels; points some pixels apart count as independent.
  double search_spacing_m = 0.008;
  double spacing_m = 0.003;
  /// Share of the facets' arc heights (SkinInView::FacetError_m) that counts as error of the skin;
  /// 0: the skin is made of these facets.
  double facet_error_share = 1.0;
  /// The fit takes points nearer than `gate_sigmas` times the robust spread of their distances,
  /// within these bounds, m.
  double gate_sigmas = 5.0;
  double narrowest_gate_m = 0.002;
  double widest_gate_m = 0.015;
  /// Points are matched again until that moves the first cloud's middle, and turns it, less than
  /// this or than a tenth of the standard error.
  double moved_m = 2e-5;
  double turned_rad = 8.7e-5;
  int max_rounds = 25;
  /// Fewer points than these in a frame are none of a robot.
  int least_points = 150;
  /// Refused as none of this robot: less of the skin that should be seen has points near it, or the
  /// points on it lie farther off (RMS).
  double least_cover = 0.5;
  double most_rms_m = 0.003;
};

/// How the model explains one cloud.
struct CloudMatch {
  int points = 0;              ///< that were used, after thinning
  int matched = 0;             ///< that lie on the skin
  double rms_m = 0.0;          ///< of these, along the normal
  double outlier_share = 0.0;  ///< of the points: of other things, or too far from the skin
  double skin_covered = 0.0;   ///< share of the skin that should be seen and has points near it
};

struct CloudCalibration {
  /// kInvalidInput: no frames, numbers that are not finite, sigmas <= 0, cables that are not this
  /// robot's, or clouds of another robot. kNoRobotSeen: too few points. kUnobservable: the clouds
  /// do not determine the pose. kNotConverged: no pose near the start explains the clouds (start
  /// too far off, or another robot), or the rounds are used up. Else why an equilibrium fails.
  Status status;
  JointCalibration joint;                         ///< usable where `status` is ok
  std::vector<CloudMatch> matches;                ///< [frames]
  geometry::RigidTransform rigid_T_robot_camera;  ///< of the search with shapes held
  int starts = 0;                                 ///< of the search
  int rounds = 0;                                 ///< of matching and joint fit
};

/// Camera pose, and what `settings.request` asks for, from clouds of the robot without markers:
/// first the pose with shapes held at the equilibria under the cable inputs as they were measured
/// (SearchPose), then all together (CalibrateJointly) on points matched to the skin that is seen,
/// matched again until the camera rests. The error of a point along the normal is that of its depth
/// (its sigma times the cosine to the line of sight) and that of the facets.
///
/// From starts off by up to 50 mm and 20 degrees at the robot. A robot that looks the same after a
/// turn (config/robots/four_leg.yaml nearly does, by quarter turns) is told from itself by the
/// start alone: it must be right to less than half of that turn. The model's moduli are left with
/// what was found, on failure as they were.
CloudCalibration CalibrateFromClouds(robot::RobotModel& model,
                                     const std::vector<CloudFrame>& frames,
                                     const geometry::RigidTransform& T_robot_camera_start,
                                     const CloudSettings& settings = {});

}  // namespace palpate::calibration
