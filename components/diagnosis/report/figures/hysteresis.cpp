// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "components/diagnosis/report/figures/dominant_residual.hpp"
#include "components/diagnosis/report/figures/figures.hpp"
#include "components/diagnosis/report/figures/trace_panels.hpp"
#include "libs/core/index.hpp"

namespace palpate::diagnosis {

namespace {

constexpr std::size_t kMostLoops = 4;

double CommandOf(const ComparedSample& compared, Eigen::Index cable) {
  return cable < compared.command.size() ? compared.command[cable]
                                         : std::numeric_limits<double>::quiet_NaN();
}

/// How far a cable was moved in these samples, in its unit.
double Travel(const ComparedSamples& compared_samples, Eigen::Index cable) {
  double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
  for (const ComparedSample* compared : compared_samples) {
    const double command = CommandOf(*compared, cable);
    if (!std::isfinite(command)) continue;
    lowest = std::min(lowest, command);
    highest = std::max(highest, command);
  }
  return highest > lowest ? highest - lowest : 0.0;
}

/// A cable and the recording that shows it best.
struct Loop {
  Eigen::Index cable = 0;
  std::size_t recording = 0;
  double travel = 0.0;  ///< there, as a share of the longest of cables with this unit
};

std::string UnitOf(const DiagnosisResult& result, std::size_t cable) {
  return cable < result.cable_units.size() ? result.cable_units[cable] : "m";
}

/// How commands of a unit are drawn.
struct Quantity {
  std::string title;
  double factor = 1.0;
};

Quantity QuantityIn(const std::string& unit) {
  if (unit == "N") return {"tension commanded (N)", 1.0};
  if (unit == "Pa") return {"pressure read (kPa)", 1e-3};
  if (unit == "m3") return {"change of volume (ml)", 1e6};
  return {"displacement commanded (mm)", 1e3};
}

/// The recording in which a cable moved far and the others little.
std::vector<Loop> FindLoops(const DiagnosisResult& result,
                            const std::vector<ComparedSamples>& compared_samples) {
  std::vector<Loop> loops;
  for (std::size_t c = 0; c < result.cables.size(); ++c) {
    const auto cable = ToIndex(c);
    Loop best{cable, 0, 0.0};
    double best_score = 0.0;
    for (std::size_t r = 0; r < compared_samples.size(); ++r) {
      const double travel = Travel(compared_samples[r], cable);
      double all = 0.0;
      for (std::size_t other = 0; other < result.cables.size(); ++other) {
        const bool same_unit = UnitOf(result, other) == UnitOf(result, c);
        if (same_unit) all += Travel(compared_samples[r], ToIndex(other));
      }
      const double score = travel > 0.0 ? travel * travel / all : 0.0;
      if (score <= best_score || FindDominant(compared_samples[r]).marker < 0) continue;
      best_score = score;
      best = {cable, r, travel};
    }
    if (best_score > 0.0) loops.push_back(best);
  }
  std::map<std::string, double> longest;
  for (const Loop& loop : loops) {
    double& length = longest[UnitOf(result, static_cast<std::size_t>(loop.cable))];
    length = std::max(length, loop.travel);
  }
  for (Loop& loop : loops) {
    loop.travel /= longest[UnitOf(result, static_cast<std::size_t>(loop.cable))];
  }
  return loops;
}

TracePanel MakeLoopPanel(const DiagnosisResult& result, const Loop& loop,
                         const ComparedSamples& compared_samples) {
  const auto cable = static_cast<std::size_t>(loop.cable);
  const Quantity quantity = QuantityIn(UnitOf(result, cable));
  const DominantResidual dominant = FindDominant(compared_samples);
  TracePanel panel;
  panel.title = result.cables[cable] + ", in " + result.recordings[loop.recording].name;
  panel.note = DescribeDominant(dominant, result);
  panel.x_title = quantity.title;
  panel.directed = true;
  panel.x_range = {0.0, 0.0};
  for (const ComparedSample* compared : compared_samples) {
    const double x = quantity.factor * CommandOf(*compared, loop.cable);
    panel.x.push_back(x);
    panel.before_mm.push_back(Along_mm(dominant, compared->before_m));
    panel.after_mm.push_back(Along_mm(dominant, compared->after_m));
    if (!std::isfinite(x)) continue;
    panel.x_range = {std::min(panel.x_range.lower, x), std::max(panel.x_range.upper, x)};
  }
  const double room = 0.03 * (panel.x_range.upper - panel.x_range.lower);
  panel.x_range = {panel.x_range.lower - room, panel.x_range.upper + room};
  panel.x_ticks = plot::MakeTicks(panel.x_range, 5);
  return panel;
}

}  // namespace

Figure DrawHysteresis(const DiagnosisResult& result) {
  Figure figure{.id = "hysteresis",
                .title = "Residual against actuation, for the actuators that moved most",
                .caption =
                    "Each panel shows the marker and direction that vary most in the "
                    "recording; arrow heads follow time, so that an open loop is "
                    "hysteresis.",
                .svg = {},
                .absent = {}};
  std::vector<ComparedSamples> compared_samples(result.recordings.size());
  for (const ComparedSample& compared : result.compared_samples) {
    const auto recording = static_cast<std::size_t>(compared.recording);
    if (compared.recording >= 0 && recording < compared_samples.size())
      compared_samples[recording].push_back(&compared);
  }
  std::vector<Loop> loops = FindLoops(result, compared_samples);
  if (loops.empty()) {
    figure.absent = "No actuator moved while markers were compared.";
    return figure;
  }
  std::stable_sort(loops.begin(), loops.end(),
                   [](const Loop& a, const Loop& b) { return a.travel > b.travel; });
  loops.resize(std::min(loops.size(), kMostLoops));
  std::vector<TracePanel> panels;
  for (const Loop& loop : loops)
    panels.push_back(MakeLoopPanel(result, loop, compared_samples[loop.recording]));
  figure.svg = DrawTracePanels(figure.id, panels, !result.causes.empty());
  return figure;
}

}  // namespace palpate::diagnosis
