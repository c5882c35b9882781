// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>

#include "libs/robot/robot_description.hpp"
#include "tests/system/blind/blind_case.hpp"

namespace palpate::blind {

/// Spoils the data in an experiment folder; kNone and kOtherRobot leave them as they are. Which
/// recording it hits, `seed` says; never a rest, in which one moment is like the next.
void Corrupt(Corruption corruption, std::uint64_t seed, const std::filesystem::path& experiment);

/// The file of another robot: the beam, or one of the same names 1.4 times as large, made in
/// `folder`.
std::filesystem::path OtherRobotFile(std::uint64_t seed, const robot::RobotDescription& robot,
                                     const std::filesystem::path& folder);

}  // namespace palpate::blind
