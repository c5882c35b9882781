// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <cmath>
#include <limits>

#include "components/diagnosis/report/figures/dominant_residual.hpp"
#include "components/diagnosis/report/figures/figures.hpp"
#include "components/diagnosis/report/figures/trace_panels.hpp"
#include "libs/core/index.hpp"

namespace palpate::diagnosis {

namespace {

constexpr std::size_t kMostPanels = 4;
/// Fewer say nothing about how something goes on.
constexpr std::size_t kFewestOfHold = 5;

bool SameCommand(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  if (a.size() != b.size()) return false;
  for (Eigen::Index i = 0; i < a.size(); ++i) {
    const bool both_unknown = std::isnan(a[i]) && std::isnan(b[i]);
    if (!both_unknown && !(std::abs(a[i] - b[i]) < 1e-9)) return false;
  }
  return true;
}

/// The longest time of a recording in which no command changes.
ComparedSamples LongestHold(const ComparedSamples& compared_samples) {
  const auto lasts_s = [](const ComparedSamples& hold) {
    return hold.empty() ? 0.0 : hold.back()->t_s - hold.front()->t_s;
  };
  ComparedSamples longest, hold;
  for (const ComparedSample* compared : compared_samples) {
    if (!hold.empty() && !SameCommand(hold.back()->command, compared->command)) hold.clear();
    hold.push_back(compared);
    if (lasts_s(hold) > lasts_s(longest)) longest = hold;
  }
  return longest;
}

/// 1, 10, 100 ... and, where there is room, 2 and 5 times these, on the axis of log10.
plot::AxisTicks DecadeTicks(const plot::AxisRange& log_range) {
  const bool fine = log_range.upper - log_range.lower < 2.5;
  plot::AxisTicks ticks;
  for (double decade = std::floor(log_range.lower); decade <= log_range.upper; ++decade) {
    for (const double factor : {1.0, 2.0, 5.0}) {
      const double at = decade + std::log10(factor);
      if (at < log_range.lower - 1e-9 || at > log_range.upper + 1e-9) continue;
      if (factor > 1.0 && !fine) continue;
      ticks.values.push_back(at);
      ticks.labels.push_back(
          plot::FixedText(std::pow(10.0, at), decade < 0.0 ? static_cast<int>(-decade) : 0));
    }
  }
  return ticks;
}

/// log10 of the time since the hold began; NaN: at its beginning.
std::vector<double> LogTimes(const ComparedSamples& hold) {
  std::vector<double> log_t;
  for (const ComparedSample* compared : hold) {
    const double t_s = compared->t_s - hold.front()->t_s;
    log_t.push_back(t_s > 0.0 ? std::log10(t_s) : std::numeric_limits<double>::quiet_NaN());
  }
  return log_t;
}

TracePanel MakePanel(const DiagnosisResult& result, const ComparedSamples& hold,
                     const DominantResidual& rise) {
  TracePanel panel;
  panel.title = result.recordings[At(hold.front()->recording)].name;
  panel.note = DescribeDominant(rise, result);
  panel.x_title = "time since the hold began (s), logarithmic";
  panel.x = LogTimes(hold);
  for (const ComparedSample* compared : hold) {
    panel.before_mm.push_back(Along_mm(rise, compared->before_m));
    panel.after_mm.push_back(Along_mm(rise, compared->after_m));
  }
  const auto first = std::find_if(panel.x.begin(), panel.x.end(),
                                  [](double log_t) { return std::isfinite(log_t); });
  panel.x_range = {*first - 0.05, panel.x.back() + 0.05};
  panel.x_ticks = DecadeTicks(panel.x_range);
  return panel;
}

}  // namespace

Figure DrawHolds(const DiagnosisResult& result) {
  Figure figure{.id = "holds",
                .title = "Residual in holds against the logarithm of time",
                .caption =
                    "The commands are constant: a steadily rising line is creep, while friction "
                    "and backlash leave "
                    "it level; each panel shows the marker and direction that rise most.",
                .svg = {},
                .absent = {}};
  std::vector<ComparedSamples> compared_samples(result.recordings.size());
  for (const ComparedSample& compared : result.compared_samples) {
    const auto recording = static_cast<std::size_t>(compared.recording);
    if (compared.recording < 0 || recording >= compared_samples.size()) continue;
    if (result.recordings[recording].kind == "hold")
      compared_samples[recording].push_back(&compared);
  }
  std::vector<TracePanel> panels;
  for (const ComparedSamples& of_recording : compared_samples) {
    const ComparedSamples hold = LongestHold(of_recording);
    const DominantResidual rise = FindRise(hold, LogTimes(hold));
    if (hold.size() < kFewestOfHold || rise.marker < 0) continue;
    if (panels.size() < kMostPanels) panels.push_back(MakePanel(result, hold, rise));
  }
  if (panels.empty()) {
    figure.absent = "No recording is a hold (kind: hold) with five samples at one command.";
    return figure;
  }
  figure.svg = DrawTracePanels(figure.id, panels, !result.causes.empty());
  return figure;
}

}  // namespace palpate::diagnosis
