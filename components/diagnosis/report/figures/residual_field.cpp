// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <cmath>
#include <limits>

#include "components/diagnosis/report/figures/figures.hpp"
#include "components/diagnosis/report/figures/projected_body.hpp"
#include "components/diagnosis/report/number_text.hpp"
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
/// How long the largest residual is drawn, as a share of the body's longest side.
constexpr double kLongest = 0.2;
/// So many moments make a mean; of a recording that has no more, half of them, for what its
/// reference was off by has been taken off the mean of all.
constexpr std::size_t kMeanOf = 5;
/// More names than these cannot be read.
constexpr Eigen::Index kMostNames = 16;

/// Some moments of one recording, one after another: [first, last).
struct Stretch {
  std::size_t first = 0, last = 0;
};

/// Mean residual of each marker over the moments that saw it, m; NaN: never seen.
Eigen::Matrix3Xd MeanResidual(const DiagnosisResult& result, const Stretch& stretch,
                              Eigen::Matrix3Xd ComparedMoment::*field) {
  const Eigen::Index count = result.marker_rest_m.cols();
  Eigen::Matrix3Xd sum_m = Eigen::Matrix3Xd::Zero(3, count);
  Eigen::VectorXd seen = Eigen::VectorXd::Zero(count);
  for (std::size_t i = stretch.first; i < stretch.last; ++i) {
    const Eigen::Matrix3Xd& residual_m = result.moments[i].*field;
    for (Eigen::Index m = 0; m < std::min(count, residual_m.cols()); ++m) {
      if (!residual_m.col(m).allFinite()) continue;
      sum_m.col(m) += residual_m.col(m);
      ++seen[m];
    }
  }
  return sum_m.array().rowwise() / seen.transpose().array();
}

double Longest(const Eigen::Matrix3Xd& vectors) {
  double longest = 0.0;
  for (const auto& vector : vectors.colwise()) {
    if (vector.allFinite()) longest = std::max(longest, vector.norm());
  }
  return longest;
}

/// RMS length of those that are known.
double Rms(const Eigen::Matrix3Xd& vectors) {
  double squares = 0.0, count = 0.0;
  for (const auto& vector : vectors.colwise()) {
    if (!vector.allFinite()) continue;
    squares += vector.squaredNorm();
    ++count;
  }
  return count > 0.0 ? std::sqrt(squares / count) : 0.0;
}

/// Where the simulation is most wrong. A mean over all moments would cancel what changes its sign,
/// as friction does; a single one would show noise.
Stretch FindWorst(const DiagnosisResult& result) {
  Stretch worst;
  double largest_m = 0.0;
  for (std::size_t first = 0; first < result.moments.size(); ++first) {
    const int recording = result.moments[first].recording;
    const auto moments = static_cast<std::size_t>(
        std::count_if(result.moments.begin(), result.moments.end(),
                      [&](const ComparedMoment& moment) { return moment.recording == recording; }));
    const std::size_t mean_of = moments > kMeanOf ? kMeanOf : (moments + 1) / 2;
    Stretch stretch{first, first};
    while (stretch.last < std::min(first + mean_of, result.moments.size()) &&
           result.moments[stretch.last].recording == recording) {
      ++stretch.last;
    }
    const bool is_tail = first > 0 && stretch.last - first < mean_of &&
                         result.moments[first - 1].recording == recording;
    if (is_tail) continue;  // of a longer stretch, and noisier
    const double rms_m = Rms(MeanResidual(result, stretch, &ComparedMoment::before_m));
    if (rms_m <= largest_m) continue;
    largest_m = rms_m;
    worst = stretch;
  }
  return worst;
}

/// "02_ramp_north, 18.0 to 22.0 s"
std::string DescribeStretch(const DiagnosisResult& result, const Stretch& stretch) {
  const ComparedMoment& first = result.moments[stretch.first];
  const auto recording = static_cast<std::size_t>(first.recording);
  const std::string name =
      recording < result.recordings.size() ? result.recordings[recording].name + ", " : "";
  return name + plot::FixedText(first.t_s, 1) + " to " +
         plot::FixedText(result.moments[stretch.last - 1].t_s, 1) + " s";
}

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

/// The field, and how it is drawn in all views.
struct Field {
  Eigen::Matrix3Xd before_m, after_m;
  Eigen::Matrix3Xd outline_m;  ///< what must be inside the picture
  double enlargement = 1.0;    ///< of arrows against the body
  double px_per_mm = 1.0;
};

plot::AxisRange Range_mm(const Field& field, int axis) {
  const Eigen::Vector3d low_m = field.outline_m.rowwise().minCoeff();
  const Eigen::Vector3d high_m = field.outline_m.rowwise().maxCoeff();
  const double room_m = kMargin * (high_m - low_m).maxCoeff();
  return {1e3 * (low_m[axis] - room_m), 1e3 * (high_m[axis] + room_m)};
}

double Span_mm(const Field& field, int axis) {
  const plot::AxisRange range = Range_mm(field, axis);
  return range.upper - range.lower;
}

void DrawNames(const DiagnosisResult& result, const std::vector<SvgPoint>& places,
               std::vector<plot::Rect> taken, const PlotArea& area, SvgDocument* svg) {
  constexpr double kSize_px = 10.5;
  std::vector<plot::LabelRequest> requests;
  for (std::size_t m = 0; m < places.size(); ++m) {
    requests.push_back({{places[m].x_px, places[m].y_px},
                        plot::TextWidth_px(result.markers[m], kSize_px),
                        kSize_px + 2.0});
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
    svg->Text({middle.x_px, rects[m].bottom_px() - 2.5}, result.markers[m],
              {.anchor = SvgText::Anchor::kMiddle, .size_px = kSize_px});
  }
}

plot::Rect BoundsOf(const SvgPoint& a, const SvgPoint& b) {
  return {std::min(a.x_px, b.x_px) - 2.0, std::min(a.y_px, b.y_px) - 2.0,
          std::abs(a.x_px - b.x_px) + 4.0, std::abs(a.y_px - b.y_px) + 4.0};
}

void DrawArrows(const DiagnosisResult& result, const Field& field, const BodyView& view,
                const PlotArea& area, SvgDocument* svg) {
  std::vector<SvgPoint> places;
  std::vector<plot::Rect> taken;
  const auto place = [&](const Eigen::Vector3d& point_m) {
    return area.Place(1e3 * point_m[view.right], 1e3 * point_m[view.up]);
  };
  const auto arrow = [&](Eigen::Index m, const Eigen::Matrix3Xd& vectors_m, double width_px,
                         const plot::Color& color) {
    if (!vectors_m.col(m).allFinite()) return;
    const Eigen::Vector3d rest_m = result.marker_rest_m.col(m);
    const SvgPoint from = place(rest_m);
    const SvgPoint to = place(rest_m + field.enlargement * vectors_m.col(m));
    svg->Arrow(from, to, 4.0 * width_px, {color, width_px});
    taken.push_back(BoundsOf(from, to));
  };
  for (Eigen::Index m = 0; m < result.marker_rest_m.cols(); ++m) {
    arrow(m, field.before_m, 2.2, ink::kBefore);
    arrow(m, field.after_m, 1.8, ink::kAfter);
    places.push_back(place(result.marker_rest_m.col(m)));
    svg->Dot(places.back(), 2.2, plot::palette::kInk);
  }
  const bool named = result.markers.size() == places.size();
  if (named && result.marker_rest_m.cols() <= kMostNames) {
    DrawNames(result, places, std::move(taken), area, svg);
  }
}

void DrawPanel(const DiagnosisResult& result, const Field& field, const BodyView& view,
               const SvgPoint& corner, SvgDocument* svg) {
  const plot::AxisRange right = Range_mm(field, view.right), up = Range_mm(field, view.up);
  const PlotArea area(corner, field.px_per_mm * Span_mm(field, view.right),
                      field.px_per_mm * Span_mm(field, view.up), right, up);
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
  DrawBody(result.surface_m, result.triangles, view, area, svg);
  DrawArrows(result, field, view, area, svg);
  svg->EndGroup();
}

/// The arrow that tells how long arrows are.
void DrawScale(const Field& field, bool changed, SvgDocument* svg) {
  const double longest_m = std::max(Longest(field.before_m), Longest(field.after_m));
  std::vector<LegendEntry> entries = {{"before", ink::kBefore, LegendEntry::Mark::kLine}};
  if (changed) entries.push_back({"after", ink::kAfter, LegendEntry::Mark::kLine});
  DrawLegend(entries, {kLeft_px, 20.0}, 300.0, svg);
  if (!(longest_m > 0.0)) return;
  const double shown_m = RoundDown(longest_m);
  const double length_px = 1e3 * shown_m * field.enlargement * field.px_per_mm;
  const double right_px = kFigureWidth_px - kRight_px;
  svg->Arrow({right_px - length_px, 16.0}, {right_px, 16.0}, 9.0, {plot::palette::kInk, 2.2});
  svg->Text({right_px - length_px - 10.0, 20.0},
            "arrow of " + plot::FixedText(1e3 * shown_m, Decimals(1e3 * shown_m)) + " mm",
            {.anchor = SvgText::Anchor::kEnd, .size_px = kLabelSize_px});
}

}  // namespace

Figure DrawResidualField(const DiagnosisResult& result) {
  Figure figure{.id = "residual-field",
                .title = "Where on the body: the markers' residuals at their largest",
                .caption =
                    "Arrows point from where the simulation has a marker to where it was "
                    "measured, mean over the moments that it gets most wrong (",
                .svg = {},
                .absent = {}};
  Field field;
  const Stretch worst = FindWorst(result);
  field.before_m = MeanResidual(result, worst, &ComparedMoment::before_m);
  field.after_m = MeanResidual(result, worst, &ComparedMoment::after_m);
  const double longest_m = std::max(Longest(field.before_m), Longest(field.after_m));
  if (result.moments.empty() || result.marker_rest_m.cols() == 0 || !(longest_m > 0.0)) {
    figure.absent = "No marker was compared with the simulation.";
    return figure;
  }
  field.outline_m.resize(3, result.surface_m.cols() + result.marker_rest_m.cols());
  field.outline_m << result.surface_m, result.marker_rest_m;
  const double side_m =
      (field.outline_m.rowwise().maxCoeff() - field.outline_m.rowwise().minCoeff()).maxCoeff();
  field.enlargement = RoundDown(kLongest * std::max(side_m, 1e-3) / longest_m);
  const std::vector<BodyView> views = BodyViews(field.outline_m);
  const double wide_mm = Span_mm(field, views[0].right) + Span_mm(field, views[1].right);
  const double high_mm = std::max(Span_mm(field, views[0].up), Span_mm(field, views[1].up));
  field.px_per_mm =
      std::min((kFigureWidth_px - kLeft_px - kGap_px - kRight_px) / wide_mm, kHighest_px / high_mm);
  figure.caption += DescribeStretch(result, worst) + "), drawn " +
                    plot::FixedText(field.enlargement, 0) + " times as long as to scale.";
  SvgDocument svg(kFigureWidth_px,
                  static_cast<int>(kTop_px + field.px_per_mm * high_mm + kBottom_px), figure.id);
  const bool changed = !result.causes.empty() && Longest(field.after_m) > 0.0;
  if (!changed) field.after_m.setConstant(std::numeric_limits<double>::quiet_NaN());
  DrawScale(field, changed, &svg);
  SvgPoint corner{kLeft_px, kTop_px};
  for (const BodyView& view : {views[0], views[1]}) {
    DrawPanel(result, field, view, corner, &svg);
    corner.x_px += field.px_per_mm * Span_mm(field, view.right) + kGap_px;
  }
  figure.svg = svg.Element();
  return figure;
}

}  // namespace palpate::diagnosis
