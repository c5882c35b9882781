// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/view/picture/furniture.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "components/view/picture/overlay.hpp"
#include "components/view/picture/stage.hpp"
#include "components/view/picture/text.hpp"
#include "libs/core/index.hpp"

namespace palpate::view {

namespace {

constexpr double kMargin = 48.0;
constexpr double kTitleBaseline = 64.0;
constexpr double kCaptionStep = 27.0;
constexpr double kLegendStep = 30.0;
constexpr double kFooterHeight = 120.0;
constexpr double kLegendLeft = 360.0;  // right of the axes and the scale bar

// A number with as many decimals as its step needs.
std::string FormatAtStep(double value, double step) {
  const int decimals = std::max(0, static_cast<int>(std::ceil(-std::log10(step) - 1e-9)));
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.*f", decimals, value);
  return text.data();
}

TextStyle BodyText(double px) { return {.capital_height_px = 12.5 * px, .color = palette::kInk}; }

std::vector<LegendEntry> LegendOf(const Scene& scene) {
  std::vector<LegendEntry> entries;
  for (const Points& points : scene.points) {
    if (!points.name.empty()) {
      const bool balls = points.shape == Points::Shape::kBall;
      entries.push_back({balls ? LegendEntry::Mark::kBall : LegendEntry::Mark::kCross, points.color,
                         points.name});
    }
  }
  entries.insert(entries.end(), scene.legend.begin(), scene.legend.end());
  return entries;
}

double EntryWidth(const LegendEntry& entry, double px) {
  return 62.0 * px + TextWidth(entry.text, BodyText(px));
}

// The entries of each row, so that no row is wider than the room right of the axes.
std::vector<std::vector<LegendEntry>> LegendRows(const Scene& scene, double px) {
  const double room_px = scene.width_px - (kLegendLeft + kMargin) * px;
  std::vector<std::vector<LegendEntry>> rows;
  double used_px = 0.0;
  for (const LegendEntry& entry : LegendOf(scene)) {
    if (rows.empty() || used_px + EntryWidth(entry, px) > room_px) {
      rows.emplace_back();
      used_px = 0.0;
    }
    rows.back().push_back(entry);
    used_px += EntryWidth(entry, px);
  }
  return rows;
}

void DrawMark(const LegendEntry& entry, const Eigen::Vector2d& center_px, double px, Image* image) {
  const Eigen::Vector2d half(12.0 * px, 0.0);
  switch (entry.mark) {
    case LegendEntry::Mark::kLine:
      DrawStroke(center_px - half, center_px + half, 4.0 * px, entry.color, image);
      break;
    case LegendEntry::Mark::kBall:
      DrawStroke(center_px, center_px, 15.0 * px, entry.color, image);
      break;
    case LegendEntry::Mark::kCross:
      DrawCross(center_px, 6.5 * px, 2.4 * px, entry.color, image);
      break;
  }
}

void DrawLegend(const Scene& scene, double px, Image* image) {
  const auto rows = LegendRows(scene, px);
  double baseline_px =
      scene.height_px - 44.0 * px - kLegendStep * px * (static_cast<double>(rows.size()) - 1.0);
  for (const auto& row : rows) {
    const double width_px =
        std::accumulate(row.begin(), row.end(), 0.0,
                        [&](double sum, const auto& entry) { return sum + EntryWidth(entry, px); });
    double x_px = scene.width_px - kMargin * px - width_px + 26.0 * px;
    for (const LegendEntry& entry : row) {
      DrawMark(entry, {x_px + 12.0 * px, baseline_px - 6.0 * px}, px, image);
      DrawText(entry.text, {x_px + 34.0 * px, baseline_px}, BodyText(px), image);
      x_px += EntryWidth(entry, px);
    }
    baseline_px += kLegendStep * px;
  }
}

void DrawHeading(const Scene& scene, double px, Image* image) {
  const TextStyle title{.capital_height_px = 17.5 * px, .color = palette::kInk, .bold = true};
  DrawText(scene.title, {kMargin * px, kTitleBaseline * px}, title, image);
  TextStyle caption = BodyText(px);
  caption.color = palette::kMutedInk;
  double baseline = kTitleBaseline + 34.0;
  for (const std::string& line : scene.caption) {
    DrawText(line, {kMargin * px, baseline * px}, caption, image);
    baseline += kCaptionStep;
  }
}

void DrawColorBar(const ColorBar& bar, const Rect& rect, double px, Image* image) {
  const int rows = static_cast<int>(std::round(rect.height_px));
  for (int row = 0; row < rows; ++row) {
    const double share = 1.0 - (row + 0.5) / rows;
    FillRect({rect.x_px, rect.y_px + row, rect.width_px, 1.0}, SequentialColor(share), 1.0, image);
  }
  const double maximum = bar.maximum * bar.shown_per_unit;
  const double step = RoundStepBelow(maximum / 3.0);
  for (int i = 0; i * step <= maximum * (1.0 + 1e-9); ++i) {
    const double y_px = rect.bottom_px() - i * step / maximum * rect.height_px;
    DrawStroke({rect.right_px() + 1.0 * px, y_px}, {rect.right_px() + 6.0 * px, y_px}, 1.4 * px,
               palette::kInk, image);
    DrawText(FormatAtStep(i * step, step), {rect.right_px() + 13.0 * px, y_px + 6.0 * px},
             BodyText(px), image);
  }
  TextStyle title = BodyText(px);
  title.align = Align::kRight;
  DrawText(bar.title, {image->width_px - kMargin * px, rect.y_px - 24.0 * px}, title, image);
}

void DrawAxis(const Eigen::Vector2d& origin_px, const Eigen::Vector2d& along_px, char name,
              const Color& color, double px, Image* image) {
  const double length_px = along_px.norm();
  const Eigen::Vector2d tip = origin_px + along_px;
  DrawStroke(origin_px, tip, 2.6 * px, color, image);
  if (length_px > 12.0 * px) {
    const Eigen::Vector2d back = -8.0 * px * along_px / length_px;
    const Eigen::Vector2d side = 0.5 * Eigen::Vector2d(-back.y(), back.x());
    DrawStroke(tip, tip + back + side, 2.6 * px, color, image);
    DrawStroke(tip, tip + back - side, 2.6 * px, color, image);
  }
  const Eigen::Vector2d out =
      length_px > 1e-9 ? Eigen::Vector2d(along_px / length_px) : Eigen::Vector2d(0.7, 0.7);
  TextStyle style = BodyText(px);
  style.color = color;
  style.align = Align::kCenter;
  style.halo_px = 2.0 * px;
  DrawText({&name, 1}, tip + 14.0 * px * out + Eigen::Vector2d(0.0, 5.0 * px), style, image);
}

void DrawAxes(const Camera& camera, int height_px, double px, Image* image) {
  constexpr double kLength = 44.0;
  const Eigen::Vector2d origin_px(104.0 * px, height_px - 66.0 * px);
  const std::array<Color, 3> colors = {palette::kAxisX, palette::kAxisY, palette::kAxisZ};
  const Eigen::Vector3d toward = camera.right().cross(camera.up());
  std::array<int, 3> order = {0, 1, 2};
  std::sort(order.begin(), order.end(), [&](int a, int b) { return toward(a) < toward(b); });
  for (const int axis : order) {
    const Eigen::Vector2d along_px =
        kLength * px * Eigen::Vector2d(camera.right()(axis), -camera.up()(axis));
    DrawAxis(origin_px, along_px, static_cast<char>('x' + axis), colors[At(axis)], px, image);
  }
}

void DrawScaleBar(const Camera& camera, int height_px, double px, Image* image) {
  const double length_m = RoundStepBelow(130.0 * px / camera.px_per_m());
  const double length_px = length_m * camera.px_per_m();
  const Eigen::Vector2d left(204.0 * px, height_px - 50.0 * px);
  const Eigen::Vector2d right = left + Eigen::Vector2d(length_px, 0.0);
  const Eigen::Vector2d tick(0.0, 5.0 * px);
  DrawStroke(left, right, 2.2 * px, palette::kInk, image);
  DrawStroke(left - tick, left + tick, 2.2 * px, palette::kInk, image);
  DrawStroke(right - tick, right + tick, 2.2 * px, palette::kInk, image);
  const double shown_mm = 1000.0 * length_m;
  TextStyle style = BodyText(px);
  style.align = Align::kCenter;
  DrawText(FormatAtStep(shown_mm, shown_mm) + " mm",
           0.5 * (left + right) - Eigen::Vector2d(0.0, 14.0 * px), style, image);
}

}  // namespace

PageLayout LayOutPage(const Scene& scene) {
  PageLayout page;
  page.px = std::min(scene.height_px / 960.0, scene.width_px / 1280.0);
  page.legend_rows = static_cast<int>(LegendRows(scene, page.px).size());
  const double lines = static_cast<double>(scene.caption.size());
  const double header = scene.title.empty() && scene.caption.empty()
                            ? kMargin
                            : kTitleBaseline + 34.0 + kCaptionStep * std::max(0.0, lines - 0.5);
  const double footer = kFooterHeight + kLegendStep * std::max(0, page.legend_rows - 2);
  const double side = scene.color_bar ? 158.0 : kMargin;
  page.stage = {kMargin * page.px, header * page.px, scene.width_px - (kMargin + side) * page.px,
                scene.height_px - (header + footer) * page.px};
  const double bar_height = 0.62 * page.stage.height_px;
  page.color_bar = {scene.width_px - 128.0 * page.px,
                    page.stage.y_px + 0.5 * (page.stage.height_px - bar_height), 20.0 * page.px,
                    bar_height};
  return page;
}

void DrawFurniture(const Scene& scene, const PageLayout& page, const Camera& camera, Image* image) {
  DrawHeading(scene, page.px, image);
  if (scene.color_bar) {
    DrawColorBar(*scene.color_bar, page.color_bar, page.px, image);
  }
  DrawLegend(scene, page.px, image);
  DrawAxes(camera, scene.height_px, page.px, image);
  if (camera.orthographic()) {
    DrawScaleBar(camera, scene.height_px, page.px, image);
  }
}

}  // namespace palpate::view
