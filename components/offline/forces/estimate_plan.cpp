// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/offline/forces/estimate_plan.hpp"

#include <algorithm>
#include <optional>

#include "libs/core/error.hpp"

namespace palpate::offline {

namespace {

using experiment::Experiment;
using experiment::Recording;
using experiment::RecordingKind;

std::optional<EstimateFrom> MethodOf(const Recording& recording, const std::string& from) {
  const bool has_images = HasImages(recording);
  if (has_images && from != ToString(EstimateFrom::kMarkers)) return EstimateFrom::kShape;
  const bool images_asked = from == ToString(EstimateFrom::kShape);
  if (recording.markers && !images_asked) return EstimateFrom::kMarkers;
  return std::nullopt;
}

std::string WhatIsMissing(const std::string& from) {
  if (from == ToString(EstimateFrom::kMarkers)) return "markers";
  if (from == ToString(EstimateFrom::kShape)) return "depth images";
  return "depth images or markers";
}

}  // namespace

std::string ToString(EstimateFrom from) {
  return from == EstimateFrom::kMarkers ? "markers" : "shape";
}

bool IsContactFree(const Recording& recording) {
  switch (recording.kind) {
    case RecordingKind::kRest:
    case RecordingKind::kRamp:
    case RecordingKind::kHold:
    case RecordingKind::kCoContraction:
    case RecordingKind::kSecondSpeed:
    case RecordingKind::kRepeat: return recording.loads.empty();
    case RecordingKind::kKnownLoad:
    case RecordingKind::kBaseTilted:
    case RecordingKind::kCameraMoved:
    case RecordingKind::kFree: return false;
  }
  return false;
}

bool HasImages(const Recording& recording) {
  const auto has = [](const auto& camera) {
    return !camera.depth_images.empty() || !camera.clouds.empty();
  };
  return has(recording) || std::any_of(recording.cameras.begin(), recording.cameras.end(), has);
}

std::vector<PlannedRecording> PlanEstimates(const Experiment& experiment,
                                            const std::vector<const Recording*>& recordings,
                                            const std::string& from) {
  std::vector<PlannedRecording> plan;
  for (const Recording* recording : recordings) {
    const std::optional<EstimateFrom> method = MethodOf(*recording, from);
    if (!method) {
      throw InputError(recording->folder.string() + ": the recording has no " +
                       WhatIsMissing(from));
    }
    plan.push_back({recording, *method});
  }
  if (!recordings.empty()) return plan;
  for (const Recording& recording : experiment.recordings) {
    if (const auto method = MethodOf(recording, from)) plan.push_back({&recording, *method});
  }
  if (plan.empty()) {
    throw InputError(experiment.folder.string() + ": no recording has " + WhatIsMissing(from));
  }
  return plan;
}

std::vector<const Recording*> BiasRecordings(const Experiment& experiment) {
  std::vector<const Recording*> recordings;
  for (const Recording& recording : experiment.recordings) {
    if (IsContactFree(recording) && HasImages(recording)) recordings.push_back(&recording);
  }
  return recordings;
}

}  // namespace palpate::offline
