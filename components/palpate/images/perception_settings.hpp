// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <vector>

#include "components/perception/config.hpp"
#include "libs/experiment/experiment.hpp"

namespace palpate::command {

/// The settings perception.* with `overrides` (--set) applied; the depth noise is the experiment's
/// where it has one. Throws InputError for an unknown setting.
perception::Config PerceptionOf(const std::vector<std::string>& overrides,
                                const experiment::Experiment& experiment);

}  // namespace palpate::command
