// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/estimate/recording_comparison.hpp"

#include <fmt/core.h>

#include <utility>

#include "components/palpate/compare/force_comparison.hpp"
#include "components/view/plot/force_plot.hpp"

namespace palpate::command {

namespace {

const TruthTimeline* TimelineOf(const std::string& recording, const KnownTruth* truth) {
  if (truth == nullptr) return nullptr;
  const auto found = truth->of_recording.find(recording);
  return found == truth->of_recording.end() ? nullptr : &found->second;
}

}  // namespace

RecordingComparison::RecordingComparison(std::string recording, const KnownTruth* truth)
    : recording_(std::move(recording)),
      truth_(truth),
      timeline_(TimelineOf(recording_, truth)),
      tracks_(timeline_ != nullptr) {}

void RecordingComparison::Add(const force_estimation::ForceEstimate& estimate,
                              ComparisonSummary* all) {
  const bool is_compared = HasResult(estimate.status) &&
                           (timeline_ == nullptr || timeline_->At(estimate.t_s).has_value());
  std::vector<ComparedForce> compared = timeline_ == nullptr
                                            ? WithoutTruth(estimate)
                                            : CompareFrame(estimate, *timeline_, truth_->rules);
  for (ComparedForce& force : compared) force.recording = recording_;
  if (is_compared && has_truth()) {
    summary_.Add(compared);
    all->Add(compared);
  }
  tracks_.Add(estimate.t_s, is_compared, compared);
}

void RecordingComparison::Draw(const std::string& robot, const std::filesystem::path& file) const {
  view::SaveTimePlot(file, view::MakeForcePlot(fmt::format("{}: forces in {}", robot, recording_),
                                               tracks_.Tracks()));
}

}  // namespace palpate::command
