// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "libs/robot/robot_description.hpp"

namespace palpate::blind {

/// No real robot equals the mesh that it is diagnosed on: a body that is made on one mesh is
/// diagnosed on another.
struct RodMeshes {
  std::string body;       ///< file name of the mesh of the virtual robot, in elements of ten nodes
  std::string diagnosed;  ///< of the robot file
  fem::ElementType element = fem::ElementType::kTet10;  ///< of the robot file
};

/// By the rest of `seed` by 3: a body on a coarser mesh than the robot file's, on a finer one, and
/// a robot file in elements of four nodes.
RodMeshes MeshesOfRod(std::uint64_t seed);

/// The robot file that a rod of `seed` is diagnosed with, written to `folder`. `rod`: as shipped.
std::filesystem::path WriteDiagnosedRod(std::uint64_t seed, robot::RobotDescription rod,
                                        const std::filesystem::path& folder);

}  // namespace palpate::blind
