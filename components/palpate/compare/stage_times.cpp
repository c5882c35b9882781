// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/compare/stage_times.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "libs/core/index.hpp"
#include "libs/core/seconds.hpp"
#include "libs/core/statistics.hpp"

namespace palpate::command {

namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

constexpr std::array<const char*, StageTimes::kStages> kNames = {
    "image and network", "capture",    "to perception",  "perception",
    "to estimation",     "estimation", "to the listener"};

std::size_t Index(Milestone milestone) { return static_cast<std::size_t>(milestone); }

}  // namespace

void StageTimes::AddStamp(std::int64_t stamp_ns, Stamps* stamps) {
  if (stamps->empty() || stamp_ns > stamps->back()) stamps->push_back(stamp_ns);
}

void StageTimes::Pass(std::int64_t stamp_ns, Milestone milestone, double after_exposure_s) {
  const auto [frame, is_new] = open_.try_emplace(stamp_ns);
  if (is_new) frame->second.fill(kUnknown);
  double& age_s = frame->second[Index(milestone)];
  if (std::isfinite(age_s)) return;
  age_s = after_exposure_s;
  if (milestone == Milestone::kPublished) AddStamp(stamp_ns, &captured_ns_);
  if (milestone == Milestone::kPerceived) AddStamp(stamp_ns, &perceived_ns_);
  if (milestone == Milestone::kEstimated) AddStamp(stamp_ns, &estimated_ns_);
  if (open_.size() > kMostOpen) open_.erase(open_.begin());
}

void StageTimes::Finish(std::int64_t stamp_ns) {
  const auto frame = open_.find(stamp_ns);
  if (frame == open_.end()) return;
  const Ages& ages_s = frame->second;
  const bool whole =
      std::all_of(ages_s.begin(), ages_s.end(), [](double age_s) { return std::isfinite(age_s); });
  if (whole) {
    stamps_ns_.push_back(stamp_ns);
    ages_s_.push_back(ages_s);
  }
  open_.erase(frame);
}

std::vector<double> StageTimes::Stage_s(std::size_t stage, const std::vector<Ages>& frames) const {
  std::vector<double> times_s;
  for (const Ages& ages_s : frames) {
    times_s.push_back(ages_s[stage] - (stage == 0 ? 0.0 : ages_s[stage - 1]));
  }
  return times_s;
}

double StageTimes::Median_s(Milestone milestone) const {
  return Quantile(Stage_s(Index(milestone), ages_s_), 0.5);
}

std::vector<StageTimes::Ages> StageTimes::Slowest() const {
  std::vector<Ages> frames = ages_s_;
  const std::size_t count = std::max<std::size_t>(1, frames.size() / 100);
  std::partial_sort(frames.begin(), frames.begin() + ToIndex(count), frames.end(),
                    [](const Ages& a, const Ages& b) { return a.back() > b.back(); });
  frames.resize(count);
  return frames;
}

std::string StageTimes::CountsText() const {
  const auto within = [this](const Stamps& stamps) {
    return std::count_if(stamps.begin(), stamps.end(), [this](std::int64_t stamp_ns) {
      return stamp_ns >= estimated_ns_.front() && stamp_ns <= estimated_ns_.back();
    });
  };
  return fmt::format("  {:<18} {} states, {} frames captured, {} perceived, {} estimated\n",
                     "counts", within(states_ns_), within(captured_ns_), within(perceived_ns_),
                     within(estimated_ns_));
}

std::string StageTimes::ToCsv() const {
  std::string text =
      "t_s,picture_ms,capture_ms,to_perception_ms,perception_ms,to_estimation_ms,estimation_ms,"
      "to_listener_ms,sum_ms\n";
  for (std::size_t frame = 0; frame < ages_s_.size(); ++frame) {
    text += fmt::format("{:.3f}", NsToSeconds(stamps_ns_[frame] - stamps_ns_.front()));
    double before_s = 0.0;
    for (const double age_s : ages_s_[frame]) {
      text += fmt::format(",{:.3f}", 1e3 * (age_s - before_s));
      before_s = age_s;
    }
    text += fmt::format(",{:.3f}\n", 1e3 * before_s);
  }
  return text;
}

std::string StageTimes::ToText() const {
  if (ages_s_.empty()) return {};
  std::string text = CountsText();
  text +=
      fmt::format("  {:<18} {:<20} median    p99   mean of the slowest 1 %, ms\n", "stages", "");
  const std::vector<Ages> slowest = Slowest();
  for (std::size_t stage = 0; stage < kStages; ++stage) {
    const std::vector<double> times_s = Stage_s(stage, ages_s_);
    text += fmt::format("  {:<18} {:<20} {:6.1f} {:6.1f} {:6.1f}\n", "", kNames[stage],
                        1e3 * Quantile(times_s, 0.5), 1e3 * Quantile(times_s, 0.99),
                        1e3 * Mean(Stage_s(stage, slowest)));
  }
  return text;
}

}  // namespace palpate::command
