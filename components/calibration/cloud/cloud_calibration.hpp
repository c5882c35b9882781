// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <optional>
#include <string>
#include <vector>

#include "components/calibration/cloud/cloud_frame.hpp"
#include "components/calibration/cloud/pose_search.hpp"
#include "components/calibration/cloud/surface_errors.hpp"
#include "components/calibration/joint/joint_calibration.hpp"
#include "components/calibration/joint/joint_request.hpp"

namespace palpate::calibration {

/// A depth camera beside the first that is calibrated with it.
struct CloudCamera {
  std::string name;
  geometry::RigidTransform T_robot_camera_start;  ///< as of the first
  std::optional<PosePrior> pose_prior = {};
  bool fit_depth_bias = true;
};

struct CloudSettings {
  /// Parameters that are estimated beside the pose, by default actuator offsets. Its `pose` has no
  /// meaning here, its marker settings only with `marker_frames`.
  JointRequest request;
  /// Frames with markers that are fitted together with the clouds. Those without a pose of their
  /// own are in the frame of that camera.
  std::vector<CalibrationFrame> marker_frames = {};
  double huber_threshold = 2.0;  ///< standard deviations; replaces the request's
  /// Prior standard deviation of each coefficient of the depth bias, as a share of z
  /// (geometry::DepthBiasMap). Coefficients that are not estimated, or not determined, stay at 0
  /// and are considered in the covariance. 0: no depth bias.
  double depth_bias_sigma = 0.003;
  geometry::DepthBiasBasis depth_bias = {};
  bool fit_depth_bias = true;  ///< estimate that of the first camera
  std::vector<CloudCamera> further_cameras = {};
  SurfaceErrorSettings surface_errors;
  PoseSearchSettings search;
  /// Spacing of the points that are used, m: in the search, and in the joint fit. Depth noise is
  /// correlated between neighbouring pixels; points some pixels apart count as independent.
  double search_spacing_m = 0.008;
  double spacing_m = 0.003;
  /// Share of the facets' arc heights (SurfaceInView::FacetError_m) that counts as surface error;
  /// 0: the surface consists of these facets.
  double facet_error_share = 1.0;
  /// The fit uses points nearer than `gate_sigmas` robust standard deviations of the distances,
  /// within these bounds, m.
  double gate_sigmas = 5.0;
  double narrowest_gate_m = 0.002;
  double widest_gate_m = 0.015;
  /// Matching and fit repeat until they move the first cloud's centroid, and turn it, by less than
  /// this or a tenth of the standard error.
  double moved_m = 2e-5;
  double turned_rad = 8.7e-5;
  int max_rounds = 25;
  /// Smallest number of points of a robot in a frame.
  int least_points = 150;
  /// Smallest coverage of the visible surface, and largest RMS distance of its points, of this
  /// robot.
  double least_cover = 0.5;
  double most_rms_m = 0.003;
};

/// How the model explains one cloud.
struct CloudMatch {
  int points = 0;                ///< used points, after thinning
  int matched = 0;               ///< on the surface
  double rms_m = 0.0;            ///< distance of these along the normal
  double outlier_share = 0.0;    ///< share of unmatched points
  double surface_covered = 0.0;  ///< share of the visible surface with points near it
};

struct CloudCalibration {
  /// kInvalidInput: no frames, numbers that are not finite, sigmas <= 0, another number of cables
  /// or of cameras, or another robot. kNoRobotSeen: too few points, or a camera without a cloud.
  /// kUnobservable: the clouds do not determine a pose. kNotConverged: no pose near the initial one
  /// explains the clouds, or max_rounds. Otherwise the status of a failed equilibrium.
  Status status;
  /// Valid where `status` is ok. Its frames are those of the clouds, then the marker frames.
  JointCalibration joint;
  std::vector<CloudMatch> matches;  ///< [frames] of the first camera; no points: it sees no robot
  std::vector<std::vector<CloudMatch>> further_matches;  ///< [further cameras] the same
  geometry::RigidTransform rigid_T_robot_camera;  ///< of the first, by the search with fixed shapes
  int starts = 0;                                 ///< of that search
  int rounds = 0;                                 ///< of matching and fit
};

/// Poses of all cameras and the parameters of `settings.request` from clouds of the robot without
/// markers: first each pose with shapes fixed at the equilibria under the measured inputs
/// (SearchPose), then all parameters (CalibrateJointly) on points matched to the visible surface.
/// Matching and fit repeat until the cameras rest. The error of a point along the normal combines
/// its depth noise and the facets.
///
/// Initial poses may be off by 50 mm and 20 degrees at the robot. For a symmetric robot
/// (config/robots/four_leg.yaml nearly is, by quarter turns) only the initial pose decides, and it
/// must be right to less than half of that turn. On success the model has the estimates, on failure
/// it is unchanged.
CloudCalibration CalibrateFromClouds(robot::RobotModel& model,
                                     const std::vector<CloudFrame>& frames,
                                     const geometry::RigidTransform& T_robot_camera_start,
                                     const CloudSettings& settings = {});

/// Whether such a fit is one of the robot. Noise, the facets of the mesh and a sound model's errors
/// leave a chi-squared below the degrees of freedom. Twice these errors are another body than the
/// model's: the pose is fitted to that, too.
bool IsPossible(const JointCalibration& fit);

/// Whether a fit of all cameras is of the robot that the `first` of them shows: chi-squared per
/// degree of freedom is at most twice that of its own fit. Otherwise a camera or the robot moved,
/// or clocks differ.
bool AgreesWith(const JointCalibration& first, const JointCalibration& all);

}  // namespace palpate::calibration
