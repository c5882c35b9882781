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
  /// Ends where what all further iterations would change in the inputs is expected to be no more,
  /// N; 0: all I_1 iterations are made.
  double tolerance_N = 1e-7;
  /// ... and the configuration is as near to equilibrium: residual over the size of the forces.
  double balance_tolerance = 1e-9;
  /// Omega, [a]; empty: tensions from 0 to the robot file's max_tension_N.
  std::vector<CableLimits> limits = {};
  /// An input known no better (one sigma) counts as not determined by the markers.
  double undetermined_sigma_N = 10.0;
  /// The robot is another one where the residual is so many times what its errors explain.
  double wrong_robot_ratio = 5.0;
};

/// The paper's Algorithm 1: camera pose and cable inputs from labelled markers of one picture, the
/// robot's shape, material and geometry taken as known. In turns the pose for given inputs (7) and
/// the inputs for a given pose (8), (9), the configuration following by (6). Both minimise the same
/// sum, here of Mahalanobis distances, so that what it converges to is the joint minimum; it does
/// so linearly, the slower the more a rigid motion looks like what the cables do.
///
/// The tangent is taken anew each time that what is left to change has shrunk tenfold, and always
/// where the inputs still move; this changes the cost and not what is converged to.
///
/// Starts from the equilibrium without tension. `model` is used for solving and left as it was.
/// Where (6) leads astray (an element turns inside out, no tangent), the equilibrium is followed to
/// the new inputs instead, halfway where need be. The result is in equilibrium: it is solved for at
/// the end.
///
/// Mirrored markers are told by a reflection that explains them far better, at once or with inputs
/// of its own. Markers that lie in one plane whatever the cables do cannot tell it.
PoseAndInputs RunAlgorithm1(robot::RobotModel& model, const std::vector<MarkerSighting>& sightings,
                            const Algorithm1Settings& settings = {});

}  // namespace palpate::calibration
