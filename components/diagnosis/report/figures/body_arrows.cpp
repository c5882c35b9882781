// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/report/figures/body_arrows.hpp"

#include <algorithm>
#include <cmath>

#include "components/diagnosis/report/figures/figure.hpp"
#include "components/diagnosis/report/figures/projected_body.hpp"
#include "libs/plot/label_layout.hpp"
#include "libs/plot/plot_area.hpp"
#include "libs/plot/text_width.hpp"

namespace palpate::diagnosis {

namespace {

using plot::PlotArea;
using plot::SvgDocument;
using plot::SvgPoint;
using plot::SvgText;

constexpr double kTop_px = 58.0, kBottom_px = 44.0, kLeft_px = 58.0, kGap_px = 66.0;
constexpr double kRight_px = 12.0, kHighest_px = 300.0;
/// Room round the body for arrows and names, as a share of its longest side.
constexpr double kMargin = 0.1;
/// How long the longest arrow is drawn, as a share of the body's longest side.
constexpr double kLongest = 0.2;
/// More names than these cannot be read.
constexpr Eigen::Index kMostNames = 16;

/// The largest of 1, 2, 5 times a power of ten that is not above `value`.
double RoundDown(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double factor : {5.0, 2.0}) {
    if (factor * power <= value) return factor * power;
  }
  return power;
}

/// That a number with one significant digit needs.
int Decimals(double value) {
  return std::max(0, static_cast<int>(-std::floor(std::log10(value) + 1e-9)));
}

double LongestOf(const BodyArrows& arrows) {
  return std::max(Longest(arrows.before), Longest(arrows.after));
}

/// What must be inside the depth frame.
Eigen::Matrix3Xd Outline_m(const DiagnosisResult& result, const BodyArrows& arrows) {
  Eigen::Matrix3Xd outline_m(3, result.surface_m.cols() + arrows.foot_m.cols());
  outline_m << result.surface_m, arrows.foot_m;
  return outline_m;
}

/// What is drawn, and how in all views.
struct Drawing {
  const DiagnosisResult& result;
  const BodyArrows& arrows;
  Eigen::Matrix3Xd outline_m;
  double mm_per_unit = 1.0;
  double px_per_mm = 1.0;
};

plot::AxisRange Range_mm(const Drawing& drawing, int axis) {
  const Eigen::Vector3d low_m = drawing.outline_m.rowwise().minCoeff();
  const Eigen::Vector3d high_m = drawing.outline_m.rowwise().maxCoeff();
  const double room_m = kMargin * (high_m - low_m).maxCoeff();
  return {1e3 * (low_m[axis] - room_m), 1e3 * (high_m[axis] + room_m)};
}

double Span_mm(const Drawing& drawing, int axis) {
  const plot::AxisRange range = Range_mm(drawing, axis);
  return range.upper - range.lower;
}

void DrawNames(const std::vector<std::string>& names, const std::vector<SvgPoint>& places,
               std::vector<plot::Rect> taken, const PlotArea& area, SvgDocument* svg) {
  constexpr double kSize_px = 10.5;
  std::vector<plot::LabelRequest> requests;
  for (std::size_t m = 0; m < places.size(); ++m) {
    requests.push_back(
        {{places[m].x_px, places[m].y_px}, plot::TextWidth_px(names[m], kSize_px), kSize_px + 2.0});
  }
  const plot::Rect inside{area.left_px(), area.top_px(), area.width_px(), area.height_px()};
  const auto rects = plot::PlaceLabels(requests, inside, std::move(taken),
                                       [](int /*x*/, int /*y*/) { return 0.0; });
  for (std::size_t m = 0; m < rects.size(); ++m) {
    const SvgPoint middle{rects[m].x_px + 0.5 * rects[m].width_px,
                          rects[m].y_px + 0.5 * rects[m].height_px};
    const double off_px = std::hypot(
        std::max(0.0, std::abs(middle.x_px - places[m].x_px) - 0.5 * rects[m].width_px),
        std::max(0.0, std::abs(middle.y_px - places[m].y_px) - 0.5 * rects[m].height_px));
    if (off_px > 18.0) svg->Line(places[m], middle, {plot::palette::kMutedInk, 0.6});
    svg->Polygon({{rects[m].x_px - 1.0, rects[m].y_px},
                  {rects[m].right_px() + 1.0, rects[m].y_px},
                  {rects[m].right_px() + 1.0, rects[m].bottom_px()},
                  {rects[m].x_px - 1.0, rects[m].bottom_px()}},
                 plot::palette::kPaper, 0.7);
    svg->Text({middle.x_px, rects[m].bottom_px() - 2.5}, names[m],
              {.anchor = SvgText::Anchor::kMiddle, .size_px = kSize_px});
  }
}

plot::Rect BoundsOf(const SvgPoint& a, const SvgPoint& b) {
  return {std::min(a.x_px, b.x_px) - 2.0, std::min(a.y_px, b.y_px) - 2.0,
          std::abs(a.x_px - b.x_px) + 4.0, std::abs(a.y_px - b.y_px) + 4.0};
}

void DrawArrows(const Drawing& drawing, const BodyView& view, const PlotArea& area,
                SvgDocument* svg) {
  const BodyArrows& arrows = drawing.arrows;
  std::vector<SvgPoint> places;
  std::vector<plot::Rect> taken;
  const auto place = [&](const Eigen::Vector3d& point_mm) {
    return area.Place(point_mm[view.right], point_mm[view.up]);
  };
  const auto arrow = [&](Eigen::Index k, const Eigen::Matrix3Xd& vectors, double width_px,
                         const plot::Color& color) {
    if (!vectors.col(k).allFinite()) return;
    const Eigen::Vector3d foot_mm = 1e3 * arrows.foot_m.col(k);
    const SvgPoint from = place(foot_mm);
    const SvgPoint to = place(foot_mm + drawing.mm_per_unit * vectors.col(k));
    svg->Arrow(from, to, 4.0 * width_px, {color, width_px});
    taken.push_back(BoundsOf(from, to));
  };
  for (Eigen::Index k = 0; k < arrows.foot_m.cols(); ++k) {
    arrow(k, arrows.before, 2.2, ink::kBefore);
    arrow(k, arrows.after, 1.8, ink::kAfter);
    places.push_back(place(1e3 * arrows.foot_m.col(k)));
    svg->Dot(places.back(), 2.2, plot::palette::kInk);
  }
  const bool named = arrows.names.size() == places.size();
  if (named && arrows.foot_m.cols() <= kMostNames) {
    DrawNames(arrows.names, places, std::move(taken), area, svg);
  }
}

void DrawPanel(const Drawing& drawing, const BodyView& view, const SvgPoint& corner,
               SvgDocument* svg) {
  const plot::AxisRange right = Range_mm(drawing, view.right), up = Range_mm(drawing, view.up);
  const PlotArea area(corner, drawing.px_per_mm * Span_mm(drawing, view.right),
                      drawing.px_per_mm * Span_mm(drawing, view.up), right, up);
  const auto ticks = [](const plot::AxisRange& range, double length_px) {
    return plot::MakeTicks(range, static_cast<int>(length_px / 60.0));
  };
  plot::DrawAxes(area, ticks(right, area.width_px()), ticks(up, area.height_px()), true, svg);
  svg->Text({area.left_px(), area.top_px() - 8.0}, "seen " + view.name,
            {.size_px = kLabelSize_px, .bold = true});
  constexpr const char* kAxes[] = {"x (mm)", "y (mm)", "z (mm)"};
  svg->Text({0.5 * (area.left_px() + area.right_px()), area.bottom_px() + 34.0}, kAxes[view.right],
            {.anchor = SvgText::Anchor::kMiddle, .size_px = kLabelSize_px});
  svg->Text({area.left_px() - 42.0, 0.5 * (area.top_px() + area.bottom_px())}, kAxes[view.up],
            {.anchor = SvgText::Anchor::kMiddle, .size_px = kLabelSize_px, .turned_deg = 90.0});
  svg->BeginGroup("panel", corner, area.width_px(), area.height_px());
  DrawBody(drawing.result.surface_m, drawing.result.triangles, view, area, svg);
  DrawArrows(drawing, view, area, svg);
  svg->EndGroup();
}

/// The arrow that tells how long arrows are.
void DrawScale(const Drawing& drawing, SvgDocument* svg) {
  std::vector<LegendEntry> entries = {{"before", ink::kBefore, LegendEntry::Mark::kLine}};
  if (Longest(drawing.arrows.after) > 0.0) {
    entries.push_back({"after", ink::kAfter, LegendEntry::Mark::kLine});
  }
  DrawLegend(entries, {kLeft_px, 20.0}, 300.0, svg);
  const double shown = RoundDown(LongestOf(drawing.arrows));
  const double length_px = shown * drawing.mm_per_unit * drawing.px_per_mm;
  const double right_px = kFigureWidth_px - kRight_px;
  svg->Arrow({right_px - length_px, 16.0}, {right_px, 16.0}, 9.0, {plot::palette::kInk, 2.2});
  svg->Text({right_px - length_px - 10.0, 20.0},
            "arrow of " + plot::FixedText(shown, Decimals(shown)) + " " + drawing.arrows.unit,
            {.anchor = SvgText::Anchor::kEnd, .size_px = kLabelSize_px});
}

}  // namespace

double Longest(const Eigen::Matrix3Xd& vectors) {
  double longest = 0.0;
  for (const auto& vector : vectors.colwise()) {
    if (vector.allFinite()) longest = std::max(longest, vector.norm());
  }
  return longest;
}

double Enlargement(const DiagnosisResult& result, const BodyArrows& arrows) {
  const Eigen::Matrix3Xd outline_m = Outline_m(result, arrows);
  const double side_m =
      (outline_m.rowwise().maxCoeff() - outline_m.rowwise().minCoeff()).maxCoeff();
  return RoundDown(1e3 * kLongest * std::max(side_m, 1e-3) / LongestOf(arrows));
}

std::string DrawBodyArrows(const DiagnosisResult& result, const BodyArrows& arrows,
                           const std::string& id) {
  Drawing drawing{.result = result,
                  .arrows = arrows,
                  .outline_m = Outline_m(result, arrows),
                  .mm_per_unit = Enlargement(result, arrows)};
  const std::vector<BodyView> views = BodyViews(drawing.outline_m);
  const double wide_mm = Span_mm(drawing, views[0].right) + Span_mm(drawing, views[1].right);
  const double high_mm = std::max(Span_mm(drawing, views[0].up), Span_mm(drawing, views[1].up));
  drawing.px_per_mm =
      std::min((kFigureWidth_px - kLeft_px - kGap_px - kRight_px) / wide_mm, kHighest_px / high_mm);
  SvgDocument svg(kFigureWidth_px,
                  static_cast<int>(kTop_px + drawing.px_per_mm * high_mm + kBottom_px), id);
  DrawScale(drawing, &svg);
  SvgPoint corner{kLeft_px, kTop_px};
  for (const BodyView& view : {views[0], views[1]}) {
    DrawPanel(drawing, view, corner, &svg);
    corner.x_px += drawing.px_per_mm * Span_mm(drawing, view.right) + kGap_px;
  }
  return svg.Element();
}

}  // namespace palpate::diagnosis
