// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "components/diagnosis/design/next_experiment.hpp"
#include "libs/experiment/experiment.hpp"

namespace palpate::diagnosis {

/// A recording that is to be made next, and what for.
struct PlannedRecording {
  RankedProposal ranked;
  std::string name;     ///< of its folder; sorts after those that were made
  std::string tells;    ///< "a mass on the body from bent rest shape of the body"
  double rest_s = 2.0;  ///< with all commands at zero before it begins
};

/// A name for a further recording of an experiment.
std::string NextName(const experiment::Experiment& experiment, experiment::RecordingKind kind);

/// The recording as a person and a robot make it, in `folder`: recording.yaml, actuation.csv (where
/// something is driven), loads.csv (where a weight hangs), by_hand.txt, and for the virtual bench
/// recording.scenario.yaml, an item of a scenario's `recordings` (not where tensions are
/// commanded, which it cannot say). Files of these names are overwritten, or removed. Throws
/// RunError.
void WritePlan(const PlannedRecording& plan, const std::filesystem::path& folder);

/// The first in `folder`/plan, those behind it in `folder`/plan_others/02 and so on. What was
/// planned there before is removed; nothing else that lies there is. Throws RunError.
void WritePlans(const std::vector<PlannedRecording>& plans, const std::filesystem::path& folder);

/// Removes what WritePlan writes.
void RemovePlan(const std::filesystem::path& folder);

}  // namespace palpate::diagnosis
