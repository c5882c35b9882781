// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <vector>

#include "libs/plot/svg_document.hpp"

namespace palpate::diagnosis {

/// A depth frame of the report. Either `svg` or `absent` is empty.
struct Figure {
  std::string id;       ///< of the HTML element
  std::string title;    ///< plain text
  std::string caption;  ///< one sentence, plain text
  std::string svg;      ///< an svg element
  std::string absent;   ///< why there is no depth frame, one sentence
};

/// All depth frames are as wide as a page of A4 between its margins, so that texts print as large
/// as they are meant.
inline constexpr int kFigureWidth_px = 720;
inline constexpr double kLabelSize_px = 12.0;

/// After Okabe and Ito: distinguishable with any colour vision; light and dark alternate.
namespace ink {
inline constexpr plot::Color kBefore = plot::FromHex(0xD55E00);
inline constexpr plot::Color kNominal = plot::FromHex(0xE69F00);
inline constexpr plot::Color kAfter = plot::FromHex(0x0072B2);
inline constexpr plot::Color kHeldoutBefore = plot::FromHex(0xCC79A7);
inline constexpr plot::Color kHeldoutAfter = plot::FromHex(0x56B4E9);
inline constexpr plot::Color kOther = plot::FromHex(0x9AA5B1);
inline constexpr plot::Color kNone = plot::FromHex(0x009E73);
}  // namespace ink

struct LegendEntry {
  enum class Mark { kArea, kLine, kTick };
  std::string text;
  plot::Color color;
  Mark mark = Mark::kArea;
};

/// Draws entries side by side from `at` (left, base line of the text), in new rows below where
/// `width_px` is full.
void DrawLegend(const std::vector<LegendEntry>& entries, const plot::SvgPoint& at, double width_px,
                plot::SvgDocument* svg);

/// How high that is, px.
double LegendHeight_px(const std::vector<LegendEntry>& entries, double width_px);

}  // namespace palpate::diagnosis
