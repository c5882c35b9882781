// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <vector>

#include "components/offline/forces/loads_on_body.hpp"
#include "libs/experiment/experiment.hpp"

namespace palpate::command {

/// The recordings of these names, in this order. Throws InputError for one that is not there, with
/// "did you mean".
std::vector<const experiment::Recording*> ChooseRecordings(const experiment::Experiment& experiment,
                                                           const std::vector<std::string>& names);

/// The recordings that determine a material: with markers, without unknown contacts (any kind but
/// `free`), and with a static phase: a steady window, or a kind that is static throughout. Throws
/// InputError where there is none.
std::vector<const experiment::Recording*> RecordingsWithKnownLoads(
    const experiment::Experiment& experiment);

/// Whether RecordingsWithKnownLoads takes it.
bool HasKnownLoads(const experiment::Recording& recording);

/// Refuses a recording of kind known_load without loads.csv, whose deflection would be taken for a
/// soft body: InputError with the remedy.
void RequireLoads(const experiment::Recording& recording);

using offline::RequireLoadsOnBody;

}  // namespace palpate::command
