// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <string>

namespace palpate::blind {

/// Whether robots of this name are made and diagnosed with linear cells (WriteCoarseRobot): those
/// with chambers, so that a set of them ends in a night.
bool IsCoarse(const std::string& robot);

/// Writes the file of a robot of config/robots with linear cells of `<robot>_coarse.msh`
/// (config/scenarios) into `folder`, and returns it. Virtual robots of CoarseScenario have the same
/// cells, so that the mesh is no fault.
std::filesystem::path WriteCoarseRobot(const std::string& robot,
                                       const std::filesystem::path& folder);

/// A scenario with linear cells.
std::string CoarseScenario(const std::string& scenario);

}  // namespace palpate::blind
