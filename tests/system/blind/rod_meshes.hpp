// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "libs/robot/robot_description.hpp"

namespace palpate::blind {

/// No real robot equals the mesh that it is diagnosed on: a body that is made on one mesh is
/// diagnosed on another. File names; elements of ten nodes.
struct RodMeshes {
  std::string body;       ///< of the virtual robot
  std::string diagnosed;  ///< of the robot file
};

/// A coarser body than the robot file's, or a finer one, in turn over the healthy seeds.
RodMeshes MeshesOfRod(std::uint64_t seed);

/// The robot file that a rod of `seed` is diagnosed with, written to `folder`. `rod`: as shipped.
std::filesystem::path WriteDiagnosedRod(std::uint64_t seed, robot::RobotDescription rod,
                                        const std::filesystem::path& folder);

}  // namespace palpate::blind
