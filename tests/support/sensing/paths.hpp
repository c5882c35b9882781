// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "libs/scenario/random.hpp"
#include "tests/support/sensing/sensing_scene.hpp"

namespace palpate::test_support {

/// The robot rests, then a weight of `force_N` hangs more and more at `position_m` of the
/// undeformed body, spread over `patch_radius_m`, cables at zero. Throws RunError.
std::vector<SceneState> HangWeight(SensingScene& scene, const Eigen::Vector3d& position_m,
                                   double force_N, double patch_radius_m);

/// The scene's hand (a tool of that shape) comes from a random direction above the plate, fingers
/// first, to `nearest_m` of the surface of the robot as it is, and goes away again; touches
/// nothing.
std::vector<SceneState> HandComesNear(const SensingScene& scene, double nearest_m, int frames,
                                      scenario::Random* random);

/// From the hand's surface to the nearest of the nodes [3 x n], m; < 0: inside.
double HandDistance_m(const Eigen::Isometry3d& T_robot_hand, const Eigen::Matrix3Xd& nodes_m);

}  // namespace palpate::test_support
