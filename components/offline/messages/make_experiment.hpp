// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "libs/core/config_node.hpp"

namespace palpate::offline {

/// Writes the experiment folder `out`, new or empty, from the topics of recorded messages: a file,
/// or the folder of its parts (table: docs/experiment.md). `remap`: rules FROM:=TO. `robot`: the
/// robot file that says which joints are chambers; empty: the one that is attached to the
/// recording, and without one all are cables. Returns lines for people: what was taken from where,
/// and what was left out. Throws InputError where what is needed is not there or could be meant
/// twice, RunError where nothing can be written.
std::vector<std::string> MakeExperiment(const std::filesystem::path& target,
                                        const std::vector<std::string>& remap,
                                        const std::filesystem::path& robot,
                                        const std::filesystem::path& out, const ConfigLoader& load);

}  // namespace palpate::offline
