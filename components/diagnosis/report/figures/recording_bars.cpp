// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <cmath>
#include <functional>

#include "components/diagnosis/report/figures/figures.hpp"
#include "components/diagnosis/vocabulary/number_text.hpp"
#include "libs/plot/plot_area.hpp"
#include "libs/plot/text_width.hpp"

namespace palpate::diagnosis {

namespace {

using plot::SvgText;

constexpr double kBarsTop_px = 14.0, kBarsBottom_px = 46.0, kBarsRight_px = 24.0;
constexpr double kBarsBar_px = 7.0, kBetween_px = 11.0;
constexpr double kBarsWidestName_px = 190.0;
/// More do not fit on a page; the table holds all.
constexpr std::size_t kMostRecordings = 18;

/// One bar of each recording.
struct Series {
  const char* name;
  plot::Color color;
  double RecordingError::*value_m;
};
constexpr Series kSeries[] = {
    {"before", ink::kBefore, &RecordingError::before_m},
    {"null model, fitted", ink::kNominal, &RecordingError::null_model_m},
    {"with the named causes", ink::kAfter, &RecordingError::after_m},
    {"left out: null model", ink::kHeldoutBefore, &RecordingError::heldout_before_m},
    {"left out: with the causes", ink::kHeldoutAfter, &RecordingError::heldout_after_m}};

/// Without a cause, "with the causes" would say the same twice.
std::vector<Series> UsedSeries(const DiagnosisResult& result) {
  std::vector<Series> used;
  for (const Series& series : kSeries) {
    const bool of_causes = series.value_m == &RecordingError::after_m ||
                           series.value_m == &RecordingError::heldout_after_m;
    const bool known = std::any_of(
        result.recordings.begin(), result.recordings.end(),
        [&](const RecordingError& recording) { return std::isfinite(recording.*series.value_m); });
    if (known && !(of_causes && result.causes.empty())) used.push_back(series);
  }
  return used;
}

/// Those that are shown, in their order: all, or those with the largest gaps.
std::vector<RecordingError> Shown(std::vector<RecordingError> recordings) {
  if (recordings.size() <= kMostRecordings) return recordings;
  std::vector<double> gaps_m;
  for (const RecordingError& recording : recordings) {
    gaps_m.push_back(std::isfinite(recording.before_m) ? recording.before_m : 0.0);
  }
  std::nth_element(gaps_m.begin(), gaps_m.begin() + kMostRecordings, gaps_m.end(),
                   std::greater<>());
  std::erase_if(recordings, [&](const RecordingError& recording) {
    return !(recording.before_m > gaps_m[kMostRecordings]);
  });
  return recordings;
}

void DrawRow(const RecordingError& recording, const std::vector<Series>& series,
             const plot::PlotArea& area, double top_px, plot::SvgDocument* svg) {
  double y_px = top_px;
  for (const Series& one : series) {
    const double value_m = recording.*one.value_m;
    if (std::isfinite(value_m)) {
      svg->Rectangle({area.left_px(), y_px}, area.X_px(1e3 * value_m) - area.left_px(),
                     kBarsBar_px - 1.0, one.color);
    }
    y_px += kBarsBar_px;
  }
  if (!std::isfinite(recording.noise_m)) return;
  const double noise_px = area.X_px(1e3 * recording.noise_m);
  svg->Line({noise_px, top_px - 3.0}, {noise_px, y_px + 2.0}, {plot::palette::kInk, 2.0});
}

}  // namespace

Figure DrawRecordingBars(const DiagnosisResult& result) {
  Figure figure{
      .id = "recording-bars",
      .title = "Residual in each recording, RMS over its markers' coordinates",
      .caption =
          "Left out: predicted from the other recordings alone; true causes lower these bars, too, "
          "down to the noise.",
      .svg = {},
      .absent = {}};
  const std::vector<Series> series = UsedSeries(result);
  const std::vector<RecordingError> recordings = Shown(result.recordings);
  if (recordings.empty() || series.empty()) {
    figure.absent = "No recording could be compared with the simulation.";
    return figure;
  }
  if (recordings.size() < result.recordings.size()) {
    figure.caption += " Of " + std::to_string(result.recordings.size()) + " recordings the " +
                      std::to_string(recordings.size()) + " with the largest residuals.";
  }
  double name_px = 60.0, highest_mm = 0.0;
  for (const RecordingError& recording : recordings) {
    name_px = std::max(name_px, plot::TextWidth_px(recording.name, kLabelSize_px));
    for (const Series& one : series) {
      if (recording.*one.value_m > 0.0) {
        highest_mm = std::max(highest_mm, 1e3 * recording.*one.value_m);
      }
    }
    if (recording.noise_m > 0.0) highest_mm = std::max(highest_mm, 1e3 * recording.noise_m);
  }
  name_px = std::min(name_px, kBarsWidestName_px);
  std::vector<LegendEntry> legend;
  for (const Series& one : series) legend.push_back({one.name, one.color});
  legend.push_back({"noise", plot::palette::kInk, LegendEntry::Mark::kTick});
  const double group_px = kBarsBar_px * static_cast<double>(series.size()) + kBetween_px;
  const double left_px = name_px + 20.0, width_px = kFigureWidth_px - left_px - kBarsRight_px;
  const double top_px = kBarsTop_px + LegendHeight_px(legend, kFigureWidth_px - 20.0);
  const double height_px = group_px * static_cast<double>(recordings.size()) + 4.0;
  plot::SvgDocument svg(kFigureWidth_px, static_cast<int>(top_px + height_px + kBarsBottom_px),
                        figure.id);
  DrawLegend(legend, {10.0, 18.0}, kFigureWidth_px - 20.0, &svg);
  const plot::AxisRange range =
      plot::RoundOutward({0.0, highest_mm > 0.0 ? 1.02 * highest_mm : 1.0}, 8);
  const plot::PlotArea area({left_px, top_px}, width_px, height_px, range, {0.0, 1.0});
  plot::DrawAxes(area, plot::MakeTicks(range, 8), {}, true, &svg);
  double y_px = top_px + 0.5 * kBetween_px + 2.0;
  for (const RecordingError& recording : recordings) {
    DrawRow(recording, series, area, y_px, &svg);
    svg.Text({left_px - 8.0, y_px + 0.5 * (group_px - kBetween_px) + 4.0},
             plot::Shortened(recording.name, kLabelSize_px, kBarsWidestName_px),
             {.anchor = SvgText::Anchor::kEnd, .size_px = kLabelSize_px});
    y_px += group_px;
  }
  svg.Text({left_px + 0.5 * width_px, top_px + height_px + 36.0}, "residual, RMS (mm)",
           {.anchor = SvgText::Anchor::kMiddle, .size_px = kLabelSize_px});
  figure.svg = svg.Element();
  return figure;
}

}  // namespace palpate::diagnosis
