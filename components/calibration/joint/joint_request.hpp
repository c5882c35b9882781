// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <atomic>
#include <optional>
#include <stop_token>
#include <vector>

#include "components/calibration/joint/joint_calibration.hpp"

namespace palpate::calibration {

/// Parameters that a joint calibration estimates, with their prior standard deviations.
struct JointRequest {
  bool pose = true;
  std::optional<PosePrior> pose_prior = {};  ///< of that pose; nullopt: it is unknown
  std::vector<PosePrior> own_poses = {};     ///< JointSetup::own_poses
  /// Zero offset of each actuator's displacement.
  bool actuator_offsets = true;
  double actuator_offset_sigma_m = 2e-3;
  bool actuator_gains = false;
  double actuator_gain_sigma = 0.05;
  /// Prior standard deviations of zero and gain of the pressure sensor of each chamber that has a
  /// reading; 0: not estimated.
  double pressure_zero_sigma_Pa = 500.0;
  double pressure_gain_sigma = 0.05;
  std::vector<int> moduli = {};  ///< RobotBody::materials whose Young's modulus is estimated
  double modulus_relative_sigma = 0.5;
  /// Prior standard deviations of Poisson's ratio of the same materials, of gravity's direction and
  /// of the body's mass; 0: not estimated.
  double poissons_ratio_sigma = 0.0;
  double gravity_tilt_sigma_rad = 0.0;  ///< about each of two axes across gravity
  double mass_relative_sigma = 0.0;
  /// The same of the robot's size (FrameInputs::scale), of the points from which cables are pulled
  /// and of their eyelets on the body, along each of two directions across the cable, and of the
  /// depth scale of markers. Eyelets need a model whose body has room for several such standard
  /// deviations (robot::GiveEyeletsRoom).
  double geometry_scale_sigma = 0.0;
  double cable_route_sigma_m = 0.0;
  double cable_eyelet_sigma_m = 0.0;
  double depth_scale_sigma = 0.0;
  /// Standard deviation of the depth bias common to all markers of a camera, as a share of z. It is
  /// considered in the covariance (DepthBiasPrior) where depth_scale_sigma is 0; 0: none.
  double depth_bias_sigma = 0.0;
  /// Prior standard deviation of marker offsets; 0: not estimated, and `marker_placement_sigma_m`
  /// is considered in the covariance. That default is the mesh error of quadratic elements as fine
  /// as the four legs', mostly from eyelets that sink in (measured: TableTwo). Linear elements err
  /// by three times as much.
  double marker_offset_sigma_m = 0.0;
  double marker_placement_sigma_m = 1e-4;
  /// Threads, each with a model of its own; at most one per frame.
  int threads = 2;
  double huber_threshold = 4.0;  ///< standard deviations; for wrongly assigned markers
  std::stop_token stop = {};     ///< ends the fit with kNotConverged
  /// Counts the iterations of the fit, where it is given; read from another thread.
  std::atomic<int>* iterations = nullptr;
};

/// The problem of these frames. Without a given pose the search starts from the registration of the
/// markers with those of the undeformed body, or from `pose_prior` where markers cannot be
/// registered. Where a mirror image fits nearly as well, that body
/// is replaced by the equilibria under the frames' inputs. A cable without a recorded input has an
/// unknown tension in each frame; such a chamber is open to the air. Not ok where the size of a
/// robot with chambers is to be estimated, the markers determine no pose (too few, collinear,
/// mirrored), or such an equilibrium is not reached.
Status MakeJointSetup(robot::RobotModel& model, std::vector<CalibrationFrame> frames,
                      const geometry::RigidTransform* T_robot_camera, const JointRequest& request,
                      JointSetup* setup);

/// CalibrateJointly that refuses another robot: kInvalidInput where the residual exceeds a tenth of
/// the markers' spread; the model is then unchanged.
JointCalibration CalibrateFrames(robot::RobotModel& model, std::vector<CalibrationFrame> frames,
                                 const geometry::RigidTransform* T_robot_camera,
                                 const JointRequest& request);

}  // namespace palpate::calibration
