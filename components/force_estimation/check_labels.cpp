// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/check_labels.hpp"

#include <optional>

#include "components/force_estimation/rest_markers.hpp"
#include "libs/core/error.hpp"
#include "libs/core/index.hpp"

namespace palpate::force_estimation {

namespace {

std::optional<experiment::TimeWindow> WindowAtRest(const experiment::Recording& recording) {
  if (recording.reference) return recording.reference->window_s;
  if (recording.kind != experiment::RecordingKind::kRest) return std::nullopt;
  const auto& frames = recording.markers->frames;
  return experiment::TimeWindow{frames.front().t_s, frames.back().t_s};
}

RestMarkers PairAtRest(const experiment::MarkerTracks& tracks,
                       const experiment::TimeWindow& window_s,
                       const robot::RobotDescription& robot) {
  RestMarkers pairs;
  const auto means = MeanOver(tracks, window_s);
  const auto most = ToIndex(robot.markers.size());
  pairs.measured_m.resize(3, most);
  pairs.model_m.resize(3, most);
  for (const robot::MarkerSettings& marker : robot.markers) {
    const std::optional<std::size_t> index = tracks.IndexOf(marker.name);
    if (!index || means[*index].count == 0) continue;
    const auto column = ToIndex(pairs.names.size());
    pairs.measured_m.col(column) = means[*index].mean_m;
    pairs.model_m.col(column) = marker.position_m;
    pairs.names.push_back(marker.name);
  }
  const auto count = ToIndex(pairs.names.size());
  pairs.measured_m.conservativeResize(3, count);
  pairs.model_m.conservativeResize(3, count);
  return pairs;
}

}  // namespace

void CheckMarkerLabels(const experiment::Experiment& experiment,
                       const robot::RobotDescription& robot) {
  for (const experiment::Recording& recording : experiment.recordings) {
    if (!recording.markers) continue;
    const std::optional<experiment::TimeWindow> window_s = WindowAtRest(recording);
    if (!window_s) continue;
    const auto pairs = PairAtRest(*recording.markers, *window_s, robot);
    const auto exchange = FindExchangedLabels(pairs);
    if (exchange) throw InputError(recording.folder.string() + ": " + ToText(*exchange));
  }
}

}  // namespace palpate::force_estimation
