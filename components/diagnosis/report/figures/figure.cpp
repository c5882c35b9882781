// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/report/figures/figure.hpp"

#include "libs/plot/text_width.hpp"

namespace palpate::diagnosis {

namespace {

constexpr double kMark_px = 18.0;
constexpr double kRow_px = 20.0;
constexpr double kSpace_px = 6.0;

void DrawMark(const LegendEntry& entry, const plot::SvgPoint& at, plot::SvgDocument* svg) {
  const double middle_px = at.y_px - 4.0;
  switch (entry.mark) {
    case LegendEntry::Mark::kArea:
      svg->Rectangle({at.x_px, middle_px - 5.0}, kMark_px, 10.0, entry.color);
      break;
    case LegendEntry::Mark::kLine:
      svg->Line({at.x_px, middle_px}, {at.x_px + kMark_px, middle_px}, {entry.color, 2.5});
      break;
    case LegendEntry::Mark::kTick:
      svg->Line({at.x_px + 0.5 * kMark_px, middle_px - 6.0},
                {at.x_px + 0.5 * kMark_px, middle_px + 6.0}, {entry.color, 2.0});
  }
}

/// Where each entry begins, from the first one's place.
std::vector<plot::SvgPoint> Places(const std::vector<LegendEntry>& entries, double width_px) {
  std::vector<plot::SvgPoint> places;
  plot::SvgPoint next;
  for (const LegendEntry& entry : entries) {
    const double entry_px = kMark_px + kSpace_px + plot::TextWidth_px(entry.text, kLabelSize_px);
    if (next.x_px > 0.0 && next.x_px + entry_px > width_px) next = {0.0, next.y_px + kRow_px};
    places.push_back(next);
    next.x_px += entry_px + 3.0 * kSpace_px;
  }
  return places;
}

}  // namespace

void DrawLegend(const std::vector<LegendEntry>& entries, const plot::SvgPoint& at, double width_px,
                plot::SvgDocument* svg) {
  const std::vector<plot::SvgPoint> places = Places(entries, width_px);
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const plot::SvgPoint place{at.x_px + places[i].x_px, at.y_px + places[i].y_px};
    DrawMark(entries[i], place, svg);
    svg->Text({place.x_px + kMark_px + kSpace_px, place.y_px}, entries[i].text,
              {.size_px = kLabelSize_px});
  }
}

double LegendHeight_px(const std::vector<LegendEntry>& entries, double width_px) {
  return entries.empty() ? 0.0 : Places(entries, width_px).back().y_px + kRow_px;
}

}  // namespace palpate::diagnosis
