// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/choose_recordings.hpp"

#include <algorithm>

#include "libs/core/error.hpp"
#include "libs/core/index.hpp"
#include "libs/core/text.hpp"

namespace palpate::command {

namespace {

using experiment::Recording;
using experiment::RecordingKind;

bool IsStaticThroughout(RecordingKind kind) {
  return kind == RecordingKind::kRest || kind == RecordingKind::kHold ||
         kind == RecordingKind::kKnownLoad || kind == RecordingKind::kBaseTilted;
}

}  // namespace

bool HasKnownLoads(const Recording& recording) {
  return recording.markers && recording.kind != RecordingKind::kFree &&
         (recording.steady_window_s || IsStaticThroughout(recording.kind));
}

void RequireLoads(const Recording& recording) {
  if (recording.kind != RecordingKind::kKnownLoad || !recording.loads.empty()) return;
  throw InputError(SourceLocation{(recording.folder / "loads.csv").string()},
                   "is missing, and recording '" + recording.name +
                       "' is of kind known_load; write it with the header "
                       "t_s,x_m,y_m,z_m,fx_N,fy_N,fz_N, or change the kind in recording.yaml");
}

std::vector<const Recording*> ChooseRecordings(const experiment::Experiment& experiment,
                                               const std::vector<std::string>& names) {
  std::vector<std::string> known;
  for (const Recording& recording : experiment.recordings) {
    known.push_back(recording.name);
  }
  std::vector<const Recording*> chosen;
  for (const std::string& name : names) {
    const auto found = std::find(known.begin(), known.end(), name);
    if (found == known.end()) {
      throw InputError("--recording " + name + ": the experiment has no such recording" +
                       DidYouMean(name, known) + "; it has " + Listed(known));
    }
    chosen.push_back(&experiment.recordings[At(found - known.begin())]);
  }
  return chosen;
}

std::vector<const Recording*> RecordingsWithKnownLoads(const experiment::Experiment& experiment) {
  std::vector<const Recording*> chosen;
  for (const Recording& recording : experiment.recordings) {
    if (HasKnownLoads(recording)) {
      chosen.push_back(&recording);
    }
  }
  if (chosen.empty()) {
    throw InputError(experiment.folder.string() +
                     ": no recording has markers, a static phase and known loads (kind 'free' "
                     "may hold unknown contacts); name one with --recording");
  }
  return chosen;
}

}  // namespace palpate::command
