// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <vector>

#include "libs/scenario/effect.hpp"

namespace palpate::blind {

/// Throws RunError where the experiment and its answer do not belong together (palpate simulate
/// --check, as a process), else gives what was hidden: effects that were wanted, without clutter.
std::vector<scenario::ActiveEffect> OpenAnswer(const std::filesystem::path& experiment,
                                               const std::filesystem::path& answer);

}  // namespace palpate::blind
