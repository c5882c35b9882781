// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <vector>

#include "components/perception/config.hpp"
#include "libs/experiment/experiment.hpp"

namespace palpate::command {

/// perception.* as --set (`overrides`) has it; the depth noise is the experiment's where that says
/// one. Throws InputError for a setting that is not there.
perception::Config PerceptionOf(const std::vector<std::string>& overrides,
                                const experiment::Experiment& experiment);

}  // namespace palpate::command
