// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <cmath>
#include <limits>

#include "libs/core/statistics.hpp"
#include "libs/experiment/capture_edit.hpp"

namespace palpate::experiment {

namespace {

constexpr double kQuietWindow_s = 0.5;

// Mean over the markers that are known there; infinite where none is.
double MeanVariance_m2(const std::vector<MarkerMean>& means) {
  double sum_m2 = 0.0;
  int known = 0;
  for (const MarkerMean& mean : means) {
    if (mean.count < 3) continue;
    sum_m2 += mean.deviation_m.squaredNorm();
    ++known;
  }
  return known == 0 ? std::numeric_limits<double>::infinity() : sum_m2 / known;
}

TimeWindow FindQuietWindow(const MarkerTracks& tracks) {
  const double begin_s = tracks.frames.front().t_s;
  const double end_s = tracks.frames.back().t_s;
  TimeWindow quietest{begin_s, end_s};
  double least_m2 = std::numeric_limits<double>::infinity();
  for (int i = 0; begin_s + (i + 1) * kQuietWindow_s <= end_s; ++i) {
    const TimeWindow window{begin_s + i * kQuietWindow_s, begin_s + (i + 1) * kQuietWindow_s};
    const double variance_m2 = MeanVariance_m2(MeanOver(tracks, window));
    if (variance_m2 >= least_m2) continue;
    least_m2 = variance_m2;
    quietest = window;
  }
  return quietest;
}

std::optional<double> MedianResidual(const Residuals& residuals_m, std::size_t marker) {
  std::vector<double> known_m;
  for (const auto& frame : residuals_m) {
    if (frame[marker]) known_m.push_back(*frame[marker]);
  }
  if (known_m.empty()) return std::nullopt;
  return UpperMedian(known_m);
}

MarkerQuality AssessMarker(const CapturedMarkers& captured, std::size_t marker,
                           const MarkerMean& in_noise_window) {
  MarkerQuality quality;
  quality.name = captured.tracks.names[marker];
  bool seen_before = true;
  for (const MarkerFrame& frame : captured.tracks.frames) {
    const bool seen = frame.positions_m[marker].has_value();
    if (seen) ++quality.seen;
    if (seen_before && !seen) ++quality.gaps;
    seen_before = seen;
  }
  quality.residual_m = MedianResidual(captured.residuals_m, marker);
  if (in_noise_window.count > 2) quality.noise_m = in_noise_window.deviation_m;
  return quality;
}

int CountMissingFrames(const CapturedMarkers& captured) {
  const std::vector<MarkerFrame>& frames = captured.tracks.frames;
  const double promised = (frames.back().t_s - frames.front().t_s) * captured.rate_Hz + 1.0;
  return std::max(0, static_cast<int>(std::lround(promised)) - static_cast<int>(frames.size()));
}

}  // namespace

CaptureQuality AssessCapture(const CapturedMarkers& captured,
                             const std::optional<TimeWindow>& noise_window) {
  CaptureQuality quality;
  quality.noise_window_s = noise_window ? *noise_window : FindQuietWindow(captured.tracks);
  quality.missing_frames = CountMissingFrames(captured);
  const std::vector<MarkerMean> means = MeanOver(captured.tracks, quality.noise_window_s);
  for (std::size_t marker = 0; marker < means.size(); ++marker) {
    quality.markers.push_back(AssessMarker(captured, marker, means[marker]));
  }
  return quality;
}

}  // namespace palpate::experiment
