// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/estimate/recording_comparison.hpp"

#include <fmt/core.h>

#include <nlohmann/json.hpp>
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
  const std::vector<ComparedForce> compared =
      timeline_ == nullptr ? WithoutTruth(estimate)
                           : CompareFrame(estimate, *timeline_, truth_->rules);
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

std::string ToLine(const ComparisonSummary& summary) {
  std::string line = fmt::format("{} of {} steady forces detected",
                                 summary.due() - summary.misses(), summary.due());
  const ForceScore score = summary.All();
  if (score.frames > 0) {
    line += fmt::format(
        "; error of |F| {:.1f} % (median), {:.1f} % (95 %); location error {:.1f} mm (median); "
        "{:.0f} % inside the 95 % interval",
        100.0 * score.median_relative_error, 100.0 * score.p95_relative_error,
        1e3 * score.median_location_error_m, 100.0 * score.coverage);
  }
  return line + fmt::format("; false alarms in {} of {} frames", summary.frames_with_false_alarm(),
                            summary.frames());
}

nlohmann::ordered_json ToJson(const ComparisonSummary& summary) {
  nlohmann::ordered_json json = {{"frames", summary.frames()},
                                 {"steady_forces", summary.due()},
                                 {"missed", summary.misses()},
                                 {"false_alarms", summary.false_alarms()},
                                 {"frames_with_false_alarm", summary.frames_with_false_alarm()}};
  const ForceScore score = summary.All();
  if (score.frames == 0) return json;
  json["relative_error_median"] = score.median_relative_error;
  json["relative_error_p95"] = score.p95_relative_error;
  json["location_error_m_median"] = score.median_location_error_m;
  json["coverage_of_ci95"] = score.coverage;
  return json;
}

}  // namespace palpate::command
