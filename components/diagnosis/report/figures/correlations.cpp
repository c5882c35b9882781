// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <cmath>

#include "components/diagnosis/report/figures/figures.hpp"
#include "libs/core/index.hpp"
#include "libs/plot/axis_ticks.hpp"
#include "libs/plot/text_width.hpp"

namespace palpate::diagnosis {

namespace {

using plot::SvgText;

constexpr double kMatrixTop_px = 66.0, kMatrixBottom_px = 14.0, kMatrixRight_px = 12.0;
constexpr double kScaleTitle_px = 150.0, kMatrixWidestName_px = 230.0, kLargestCell_px = 44.0;
constexpr Eigen::Index kMostCauses = 12;

/// -1: vermilion, 0: white, 1: blue.
plot::Color ColorOf(double correlation) {
  const double size = std::clamp(std::abs(correlation), 0.0, 1.0);
  return plot::Mix(plot::palette::kPaper, correlation < 0.0 ? ink::kBefore : ink::kAfter, size);
}

void DrawColorScale(double left_px, plot::SvgDocument* svg) {
  constexpr int kSteps = 41;
  constexpr double kStep_px = 5.0;
  for (int i = 0; i < kSteps; ++i) {
    svg->Rectangle({left_px + i * kStep_px, 10.0}, kStep_px + 0.5, 12.0,
                   ColorOf(2.0 * i / (kSteps - 1) - 1.0));
  }
  for (const int value : {-1, 0, 1}) {
    svg->Text(
        {left_px + 0.5 * kSteps * kStep_px * (value + 1), 36.0}, std::to_string(value),
        {.anchor = SvgText::Anchor::kMiddle, .size_px = 11.0, .color = plot::palette::kMutedInk});
  }
  svg->Text({left_px - 10.0, 20.0}, "correlation (no unit)",
            {.anchor = SvgText::Anchor::kEnd, .size_px = kLabelSize_px});
}

void DrawCell(double value, const plot::SvgPoint& corner, double cell_px, plot::SvgDocument* svg) {
  const bool known = std::isfinite(value);
  svg->Rectangle(corner, cell_px - 1.0, cell_px - 1.0,
                 known ? ColorOf(value) : plot::palette::kGridLine);
  const bool on_dark = known && std::abs(value) > 0.6;
  svg->Text({corner.x_px + 0.5 * (cell_px - 1.0), corner.y_px + 0.5 * cell_px + 3.5},
            known ? plot::FixedText(value, 2) : "?",
            {.anchor = SvgText::Anchor::kMiddle,
             .size_px = cell_px < 36.0 ? 10.0 : 11.0,
             .color = on_dark ? plot::palette::kPaper : plot::palette::kInk});
}

}  // namespace

Figure DrawCorrelations(const DiagnosisResult& result) {
  Figure figure{.id = "correlations",
                .title = "Canonical correlation of the effects of the causes in these data",
                .caption =
                    "Near 1 two causes have the same effect and are not identifiable; columns "
                    "carry the numbers "
                    "of the rows.",
                .svg = {},
                .absent = {}};
  const auto names = ToIndex(result.correlation_names.size());
  const Eigen::Index count =
      std::min({result.correlation.rows(), result.correlation.cols(), names, kMostCauses});
  if (count < 2) {
    figure.absent = "Fewer than two faults were compared.";
    return figure;
  }
  if (names > count) {
    figure.caption += " The first " + std::to_string(count) + " of " + std::to_string(names) + ".";
  }
  std::vector<std::string> rows;
  double name_px = 0.0;
  for (Eigen::Index i = 0; i < count; ++i) {
    rows.push_back(std::to_string(i + 1) + "  " + result.correlation_names[At(i)]);
    name_px = std::max(name_px, plot::TextWidth_px(rows.back(), kLabelSize_px));
  }
  const double left_px = std::clamp(name_px, kScaleTitle_px, kMatrixWidestName_px) + 20.0;
  const double cell_px = std::min(
      kLargestCell_px, (kFigureWidth_px - left_px - kMatrixRight_px) / static_cast<double>(count));
  plot::SvgDocument svg(
      kFigureWidth_px,
      static_cast<int>(kMatrixTop_px + cell_px * static_cast<double>(count) + kMatrixBottom_px),
      figure.id);
  DrawColorScale(left_px, &svg);
  for (Eigen::Index i = 0; i < count; ++i) {
    const double i_px = static_cast<double>(i) * cell_px;
    svg.Text({left_px - 8.0, kMatrixTop_px + i_px + 0.5 * cell_px + 4.0},
             plot::Shortened(rows[At(i)], kLabelSize_px, kMatrixWidestName_px),
             {.anchor = SvgText::Anchor::kEnd, .size_px = kLabelSize_px});
    svg.Text({left_px + i_px + 0.5 * cell_px, kMatrixTop_px - 7.0}, std::to_string(i + 1),
             {.anchor = SvgText::Anchor::kMiddle, .size_px = kLabelSize_px});
    for (Eigen::Index k = 0; k < count; ++k) {
      DrawCell(result.correlation(i, k),
               {left_px + static_cast<double>(k) * cell_px, kMatrixTop_px + i_px}, cell_px, &svg);
    }
  }
  figure.svg = svg.Element();
  return figure;
}

}  // namespace palpate::diagnosis
