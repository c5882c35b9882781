// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/view/plot/force_plot.hpp"

#include <algorithm>
#include <cmath>

namespace palpate::view {

namespace {

constexpr Color kHidden = FromHex(0x8E44AD);
constexpr int kFurniture_px = 112;
constexpr int kPanel_px = 150;

bool HasValue(const std::vector<double>& values) {
  return std::any_of(values.begin(), values.end(),
                     [](double value) { return std::isfinite(value); });
}

PlotPanel MakePanel(const ForceTrack& track) {
  PlotPanel panel;
  panel.title = track.contact;
  panel.value_title = "force (N)";
  if (!track.true_N.empty()) {
    panel.series.push_back({"true", palette::kTruth, true, track.t_s, track.true_N, {}});
  }
  if (HasValue(track.hidden_N)) {
    panel.series.push_back({"estimated, out of view (95 %)", kHidden, false, track.t_s,
                            track.hidden_N, track.hidden_ci95_N});
  }
  if (HasValue(track.estimated_N) || !HasValue(track.hidden_N)) {
    panel.series.push_back({"estimated (95 %)", palette::kEstimate, false, track.t_s,
                            track.estimated_N, track.ci95_N});
  }
  return panel;
}

}  // namespace

TimePlot MakeForcePlot(const std::string& title, const std::vector<ForceTrack>& tracks) {
  TimePlot plot;
  plot.title = title;
  plot.caption = "magnitude at each contact; band: 95 % interval of the estimate";
  for (const ForceTrack& track : tracks) plot.panels.push_back(MakePanel(track));
  if (plot.panels.empty()) plot.panels.push_back({"no contact", "force (N)", true, {}});
  const int panels = static_cast<int>(plot.panels.size());
  plot.height_px = std::max(plot.height_px, kFurniture_px + kPanel_px * panels + 30 * (panels - 1));
  return plot;
}

}  // namespace palpate::view
