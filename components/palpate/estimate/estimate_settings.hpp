// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "components/offline/forces/force_settings.hpp"
#include "libs/experiment/experiment.hpp"

namespace palpate::command {

/// The settings of `palpate estimate`.
using EstimateSettings = offline::ForceSettings;

/// Defaults, the depth noise of the experiment, `file` (empty: none), `overrides`
/// (KEY=VALUE), and `contacts` added to the settings' own; later ones override. Throws InputError.
/// `as_process`: with the work per frame of palpate-force-estimation, else without a limit.
EstimateSettings ReadEstimateSettings(const experiment::Experiment& experiment,
                                      const std::filesystem::path& file,
                                      const std::vector<std::string>& overrides,
                                      const std::vector<std::string>& contacts,
                                      bool as_process = false);

}  // namespace palpate::command
