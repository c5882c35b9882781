// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "components/virtual_robot/virtual_robot.hpp"
#include "libs/core/status.hpp"

namespace palpate::virtual_robot {

/// Inputs at one instant, as the step needs them.
struct BenchInputs {
  Eigen::VectorXd command_m;                           ///< [cables, then chambers] m, Pa
  std::vector<std::optional<Eigen::Isometry3d>> pose;  ///< [tools of the scenario]
  Eigen::VectorXd load_N;                              ///< [3n] all dead loads
};

/// Straight from `from` to `to`; rotations by the shortest arc. Actuators and tools that are not
/// there at one end are as they are at `to`.
BenchInputs Between(const BenchInputs& from, const BenchInputs& to, double fraction);

/// Refuses wrong sizes, values that are not finite (but a NaN command: not driven), negative masses
/// and patches, poses that are no rigid motion, and tools that the scenario does not know or that
/// are named twice.
Status CheckInputs(const Inputs& inputs, int actuators, const std::vector<scenario::Tool>& tools);

/// How far a point of a tool of `radius_m` about its origin may move from one to the other, m.
double Travel_m(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to, double radius_m);

}  // namespace palpate::virtual_robot
