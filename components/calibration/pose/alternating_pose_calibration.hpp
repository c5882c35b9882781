// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <vector>

#include "components/calibration/pose/cable_inputs.hpp"
#include "components/calibration/pose/pose_and_inputs.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::calibration {

struct Algorithm1Settings {
  int max_outer_iterations = 400;  ///< I_1 >= 1
  int inner_iterations = 1;        ///< I_2 >= 1
  /// Converged where all further iterations together are expected to change the inputs by no more,
  /// N; 0: all I_1 iterations are made.
  double tolerance_N = 1e-7;
  /// ... and the residual of the equilibrium over the size of the forces is no larger.
  double balance_tolerance = 1e-9;
  /// Omega, [a]; empty: tensions from 0 to the robot file's max_tension_N.
  std::vector<CableLimits> limits = {};
  /// An input with a larger standard deviation is not determined by the markers.
  double undetermined_sigma_N = 10.0;
  /// A residual larger than so many times its expected size means another robot.
  double wrong_robot_ratio = 5.0;
};

/// Algorithm 1 of the paper: camera pose and cable inputs from labelled markers of one frame, with
/// known material and geometry. It alternates the pose for given inputs (7) with the inputs for a
/// given pose (8), (9), and updates the configuration by (6). Both steps minimise one sum of
/// Mahalanobis distances, so that the limit is the joint minimum. Convergence is linear, and slow
/// where a rigid motion looks like a motion by the cables.
///
/// The tangent is renewed while the inputs move, and then whenever the remaining change has shrunk
/// tenfold. This changes the cost, not the limit.
///
/// It starts at the equilibrium without tension. Where (6) fails (an inverted element, no tangent),
/// a load continuation follows the equilibrium to the new inputs, or part of the way. The result is
/// a solved equilibrium. `model` is used for solving and left unchanged.
///
/// Mirrored markers are detected by a reflection that fits far better, at these inputs or with its
/// own. Markers that lie in one plane at all inputs do not show it.
PoseAndInputs RunAlgorithm1(robot::RobotModel& model, const std::vector<MarkerSighting>& sightings,
                            const Algorithm1Settings& settings = {});

}  // namespace palpate::calibration
