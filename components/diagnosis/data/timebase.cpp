// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/data/timebase.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace palpate::diagnosis {

namespace {

constexpr double kForgotten_s = 3600.0;

/// First and last stamp of what is compared; the first is beyond the last where there is none.
experiment::TimeWindow SpanOf(const experiment::Recording& recording) {
  experiment::TimeWindow span{std::numeric_limits<double>::infinity(),
                              -std::numeric_limits<double>::infinity()};
  const auto add = [&](double first_s, double last_s) {
    span.begin_s = std::min(span.begin_s, first_s);
    span.end_s = std::max(span.end_s, last_s);
  };
  if (recording.actuation && !recording.actuation->t_s.empty()) {
    add(recording.actuation->t_s.front(), recording.actuation->t_s.back());
  }
  if (recording.markers && !recording.markers->frames.empty()) {
    add(recording.markers->frames.front().t_s, recording.markers->frames.back().t_s);
  }
  for (const auto* files : {&recording.depth_images, &recording.clouds}) {
    if (!files->empty()) add(files->front().t_s(), files->back().t_s());
  }
  return span;
}

void Shift(double by_s, experiment::TimeWindow* window) {
  window->begin_s += by_s;
  window->end_s += by_s;
}

void Shift(double by_s, experiment::Recording* recording) {
  if (recording->actuation) {
    for (double& t_s : recording->actuation->t_s) t_s += by_s;
  }
  if (recording->markers) {
    for (experiment::MarkerFrame& frame : recording->markers->frames) frame.t_s += by_s;
  }
  for (auto* files : {&recording->depth_images, &recording->color_images, &recording->clouds}) {
    for (experiment::StampedFile& file : *files) file.t_ns += std::llround(1e9 * by_s);
  }
  for (experiment::KnownLoad& load : recording->loads) load.t_s += by_s;
  if (recording->reference) Shift(by_s, &recording->reference->window_s);
  if (recording->steady_window_s) Shift(by_s, &*recording->steady_window_s);
}

}  // namespace

experiment::Experiment OnOneTimebase(experiment::Experiment experiment) {
  const double rest_s = experiment.rest_between_s.value_or(kForgotten_s);
  double end_s = -std::numeric_limits<double>::infinity();
  for (experiment::Recording& recording : experiment.recordings) {
    const experiment::TimeWindow span = SpanOf(recording);
    if (span.begin_s > span.end_s) continue;
    const double by_s = span.begin_s < end_s ? end_s + rest_s - span.begin_s : 0.0;
    if (by_s > 0.0) Shift(by_s, &recording);
    end_s = span.end_s + by_s;
  }
  return experiment;
}

}  // namespace palpate::diagnosis
