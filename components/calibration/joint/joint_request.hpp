// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <stop_token>
#include <vector>

#include "components/calibration/joint/joint_calibration.hpp"

namespace palpate::calibration {

/// What a joint calibration of recorded or live frames is to find, with what a data sheet says.
struct JointRequest {
  bool pose = true;
  /// Where the displacement of each drive counts from.
  bool drive_offsets = true;
  double drive_offset_sigma_m = 2e-3;
  bool drive_gains = false;
  double drive_gain_sigma = 0.05;
  std::vector<int> moduli = {};  ///< RobotBody::materials whose Young's modulus is looked for
  double modulus_relative_sigma = 0.5;
  /// Poisson's ratio of the same materials, gravity's direction and the body's weight are looked
  /// for where how far they may be off (one sigma) is not 0.
  double poissons_ratio_sigma = 0.0;
  double gravity_tilt_sigma_rad = 0.0;  ///< about each of two axes across gravity
  double mass_relative_sigma = 0.0;
  /// The same of the robot's size (FrameInputs::scale), of the guides from which the cables are
  /// pulled and of their eyelets on the body, along each of two directions across them, and of the
  /// depth by which markers were measured, a share of it. Eyelets need a model whose body has room
  /// (robot::GiveEyeletsRoom) of some such sigmas.
  double geometry_scale_sigma = 0.0;
  double cable_route_sigma_m = 0.0;
  double cable_eyelet_sigma_m = 0.0;
  double depth_scale_sigma = 0.0;
  /// Smooth error of the depth that all of a camera's markers have in common, one sigma as a share
  /// of z: counts in the standard errors (DepthBiasPrior) where no scale of it is looked for; 0:
  /// it has none.
  double depth_bias_sigma = 0.0;
  /// How far a marker may sit from its place in the robot file: looked for where it is not 0; else
  /// it counts in the standard errors as `marker_placement_sigma_m`: what meshes of quadratic
  /// elements as fine as the four legs' make of it, mostly where cables' eyelets sink in (measured:
  /// TableTwo). Linear ones err by three times as much.
  double marker_offset_sigma_m = 0.0;
  double marker_placement_sigma_m = 1e-4;
  /// That work on frames, each with a model of its own; never more than there are frames.
  int threads = 2;
  double huber_threshold = 4.0;  ///< sigmas; for markers that are mistaken for others
  std::stop_token stop = {};     ///< ends the fit, which then is kNotConverged
};

/// The problem for these frames: where no pose is given, the search starts from the rigid motion
/// between the markers that were seen and the model's, of the body at rest; where that might be
/// taken for its mirror image, under the frames' cable inputs. Tensions of cables of which nothing
/// was recorded are unknowns of their own. Not ok where the markers tell no pose (too few, on one
/// line, mirrored), or the model has no equilibrium under inputs that it takes to tell.
Status MakeJointSetup(robot::RobotModel& model, std::vector<CalibrationFrame> frames,
                      const geometry::RigidTransform* T_robot_camera, const JointRequest& request,
                      JointSetup* setup);

/// CalibrateJointly, refusing what is not this robot: kInvalidInput where the markers lie off by
/// more than a tenth of their spread; the model is then as it was.
JointCalibration CalibrateFrames(robot::RobotModel& model, std::vector<CalibrationFrame> frames,
                                 const geometry::RigidTransform* T_robot_camera,
                                 const JointRequest& request);

}  // namespace palpate::calibration
