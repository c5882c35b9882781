// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <cmath>

#include "components/diagnosis/report/figures/figures.hpp"
#include "components/diagnosis/vocabulary/number_text.hpp"
#include "components/diagnosis/vocabulary/verdict_words.hpp"
#include "libs/plot/plot_area.hpp"
#include "libs/plot/text_width.hpp"

namespace palpate::diagnosis {

namespace {

using plot::SvgText;

constexpr double kProbabilityTop_px = 36.0, kProbabilityRow_px = 24.0, kProbabilityBar_px = 14.0,
                 kProbabilityBottom_px = 46.0;
constexpr double kProbabilityRight_px = 74.0, kProbabilityWidestName_px = 290.0;
constexpr std::size_t kMostBars = 8;

struct Bar {
  std::string name;
  double probability = 0.0;
  plot::Color color;
};

std::vector<Bar> MakeBars(const DiagnosisResult& result) {
  std::vector<Bar> bars;
  for (const NamedCause& cause : result.causes) {
    bars.push_back({WordsFor(cause.name, result), cause.probability, ink::kAfter});
  }
  for (std::size_t i = 0; i < std::min(result.rivals.size(), kMostBars); ++i) {
    const Rival& rival = result.rivals[i];
    bars.push_back({WordsFor(rival.name, result), rival.probability, ink::kOther});
  }
  bars.push_back({"none: null model", result.no_fault_probability, ink::kNone});
  bars.push_back({"other: unmodelled cause", result.other_probability, ink::kNominal});
  return bars;
}

}  // namespace

Figure DrawProbabilities(const DiagnosisResult& result) {
  Figure figure{.id = "probabilities",
                .title = "Probability of each cause, of none and of an unmodelled cause",
                .caption = "Posterior probabilities; 0.99 is the largest that is stated.",
                .svg = {},
                .absent = {}};
  if (result.causes.empty() && result.rivals.empty() && !(result.no_fault_probability > 0.0)) {
    figure.absent = "No fault was tested on these data.";
    return figure;
  }
  const std::vector<Bar> bars = MakeBars(result);
  double name_px = 0.0;
  for (const Bar& bar : bars) {
    name_px = std::max(name_px, plot::TextWidth_px(bar.name, kLabelSize_px));
  }
  const double left_px = std::min(name_px, kProbabilityWidestName_px) + 20.0;
  const double height_px = kProbabilityRow_px * static_cast<double>(bars.size()) + 6.0;
  plot::SvgDocument svg(kFigureWidth_px,
                        static_cast<int>(kProbabilityTop_px + height_px + kProbabilityBottom_px),
                        figure.id);
  std::vector<LegendEntry> legend;
  if (!result.causes.empty()) legend.push_back({"named", ink::kAfter});
  if (!result.rivals.empty()) legend.push_back({"not named", ink::kOther});
  legend.push_back({"none", ink::kNone});
  legend.push_back({"other", ink::kNominal});
  DrawLegend(legend, {left_px, 18.0}, kFigureWidth_px - left_px, &svg);
  const plot::PlotArea area({left_px, kProbabilityTop_px},
                            kFigureWidth_px - left_px - kProbabilityRight_px, height_px, {0.0, 1.0},
                            {0.0, 1.0});
  plot::DrawAxes(area, plot::MakeTicks({0.0, 1.0}, 5), {}, true, &svg);
  double y_px = kProbabilityTop_px + 8.0;
  for (const Bar& bar : bars) {
    const double share = std::isfinite(bar.probability) ? std::clamp(bar.probability, 0.0, 1.0) : 0;
    svg.Rectangle({left_px, y_px}, share * area.width_px(), kProbabilityBar_px, bar.color);
    svg.Text({left_px + share * area.width_px() + 6.0, y_px + 11.0},
             ProbabilityText(bar.probability), {.size_px = kLabelSize_px});
    svg.Text({left_px - 8.0, y_px + 11.0},
             plot::Shortened(bar.name, kLabelSize_px, kProbabilityWidestName_px),
             {.anchor = SvgText::Anchor::kEnd, .size_px = kLabelSize_px});
    y_px += kProbabilityRow_px;
  }
  svg.Text({0.5 * (area.left_px() + area.right_px()), area.bottom_px() + 36.0},
           "probability (no unit)", {.anchor = SvgText::Anchor::kMiddle, .size_px = kLabelSize_px});
  figure.svg = svg.Element();
  return figure;
}

}  // namespace palpate::diagnosis
