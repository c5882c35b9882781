// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/plot/svg_document.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "libs/core/check.hpp"
#include "libs/plot/axis_ticks.hpp"

namespace palpate::plot {

namespace {

constexpr int kDecimals = 2;

std::string Attribute(std::string_view name, std::string_view value) {
  std::string text(1, ' ');
  return text.append(name).append("=\"").append(value).append("\"");
}

std::string Attribute(std::string_view name, double value) {
  return Attribute(name, FixedText(value, kDecimals));
}

std::string PointList(const std::vector<SvgPoint>& points) {
  std::string text;
  for (const SvgPoint& point : points) {
    if (!text.empty()) text += ' ';
    text += FixedText(point.x_px, kDecimals);
    text += ',';
    text += FixedText(point.y_px, kDecimals);
  }
  return text;
}

std::string StrokeAttributes(const SvgStroke& stroke) {
  return Attribute("fill", "none") + Attribute("stroke", HexText(stroke.color)) +
         Attribute("stroke-width", stroke.width_px) + Attribute("stroke-linejoin", "round") +
         (stroke.dashed ? Attribute("stroke-dasharray", "6 4") : std::string());
}

std::string_view AnchorWord(SvgText::Anchor anchor) {
  switch (anchor) {
    case SvgText::Anchor::kStart: return "start";
    case SvgText::Anchor::kMiddle: return "middle";
    case SvgText::Anchor::kEnd: return "end";
  }
  return "start";
}

}  // namespace

SvgDocument::SvgDocument(int width_px, int height_px, const std::string& name) : name_(name) {
  PALPATE_CHECK(width_px > 0 && height_px > 0, width_px, height_px);
  const std::string width = std::to_string(width_px);
  const std::string height = std::to_string(height_px);
  head_ = "<svg" + Attribute("xmlns", "http://www.w3.org/2000/svg") + Attribute("version", "1.1") +
          Attribute("xmlns:xlink", "http://www.w3.org/1999/xlink") + Attribute("width", width) +
          Attribute("height", height) + Attribute("viewBox", "0 0 " + width + " " + height) +
          Attribute("font-family", "DejaVu Sans, Helvetica, Arial, sans-serif") + ">\n";
}

void SvgDocument::Rectangle(const SvgPoint& corner, double width_px, double height_px,
                            const Color& fill) {
  body_ += std::string("<rect") + Attribute("x", corner.x_px) + Attribute("y", corner.y_px) +
           Attribute("width", width_px) + Attribute("height", height_px) +
           Attribute("fill", HexText(fill)) + "/>\n";
}

void SvgDocument::Line(const SvgPoint& from, const SvgPoint& to, const SvgStroke& stroke) {
  body_ += std::string("<line") + Attribute("x1", from.x_px) + Attribute("y1", from.y_px) +
           Attribute("x2", to.x_px) + Attribute("y2", to.y_px) + StrokeAttributes(stroke) + "/>\n";
}

void SvgDocument::Polyline(const std::vector<SvgPoint>& points, const SvgStroke& stroke) {
  PALPATE_CHECK(points.size() >= 2, points.size());
  body_ += std::string("<polyline") + Attribute("points", PointList(points)) +
           StrokeAttributes(stroke) + "/>\n";
}

void SvgDocument::Polygon(const std::vector<SvgPoint>& points, const Color& fill, double opacity) {
  body_ += std::string("<polygon") + Attribute("points", PointList(points)) +
           Attribute("fill", HexText(fill)) + Attribute("fill-opacity", opacity) + "/>\n";
}

void SvgDocument::Facet(const std::vector<SvgPoint>& points, const Color& fill) {
  const std::string color = HexText(fill);
  body_ += std::string("<polygon") + Attribute("points", PointList(points)) +
           Attribute("fill", color) + Attribute("stroke", color) + "/>\n";
}

void SvgDocument::Dot(const SvgPoint& center, double radius_px, const Color& fill) {
  body_ += std::string("<circle") + Attribute("cx", center.x_px) + Attribute("cy", center.y_px) +
           Attribute("r", radius_px) + Attribute("fill", HexText(fill)) + "/>\n";
}

void SvgDocument::Circle(const SvgPoint& center, double radius_px, const SvgStroke& stroke) {
  body_ += std::string("<circle") + Attribute("cx", center.x_px) + Attribute("cy", center.y_px) +
           Attribute("r", radius_px) + StrokeAttributes(stroke) + "/>\n";
}

void SvgDocument::Arrow(const SvgPoint& from, const SvgPoint& to, double head_px,
                        const SvgStroke& stroke) {
  const double length_px = std::hypot(to.x_px - from.x_px, to.y_px - from.y_px);
  if (!(length_px > 0.0)) return;
  const double x = (to.x_px - from.x_px) / length_px, y = (to.y_px - from.y_px) / length_px;
  const double drawn_px = std::min(head_px, length_px);
  const SvgPoint neck{to.x_px - drawn_px * x, to.y_px - drawn_px * y};
  if (length_px > drawn_px) Line(from, neck, stroke);
  const double half_px = 0.45 * drawn_px;
  Polygon({to,
           {neck.x_px - half_px * y, neck.y_px + half_px * x},
           {neck.x_px + half_px * y, neck.y_px - half_px * x}},
          stroke.color, 1.0);
}

void SvgDocument::Text(const SvgPoint& at, std::string_view text, const SvgText& style) {
  if (text.empty()) return;
  body_ += std::string("<text") + Attribute("x", at.x_px) + Attribute("y", at.y_px) +
           Attribute("text-anchor", AnchorWord(style.anchor)) +
           Attribute("font-size", style.size_px) + Attribute("fill", HexText(style.color));
  if (style.bold) body_ += Attribute("font-weight", "bold");
  if (style.turned_deg != 0.0) {
    std::string turn = "rotate(";
    turn += FixedText(-style.turned_deg, kDecimals) + " " + PointList({at}) + ")";
    body_ += Attribute("transform", turn);
  }
  body_.append(">").append(EscapeXml(text)).append("</text>\n");
}

void SvgDocument::Image(const SvgPoint& corner, double width_px, double height_px,
                        std::string_view png_bytes) {
  body_ += std::string("<image") + Attribute("x", corner.x_px) + Attribute("y", corner.y_px) +
           Attribute("width", width_px) + Attribute("height", height_px) +
           Attribute("preserveAspectRatio", "none") +
           Attribute("xlink:href", "data:image/png;base64," + Base64(png_bytes)) + "/>\n";
}

void SvgDocument::BeginGroup(const std::string& name, const SvgPoint& corner, double width_px,
                             double height_px) {
  const std::string id = EscapeXml(name_) + "clip" + std::to_string(clip_count_++);
  clips_ += std::string("<clipPath") + Attribute("id", id) + "><rect" +
            Attribute("x", corner.x_px) + Attribute("y", corner.y_px) +
            Attribute("width", width_px) + Attribute("height", height_px) + "/></clipPath>\n";
  body_ += std::string("<g") + Attribute("class", EscapeXml(name)) +
           Attribute("clip-path", "url(#" + id + ")") + ">\n";
  ++open_groups_;
}

void SvgDocument::EndGroup() {
  PALPATE_CHECK(open_groups_ > 0, open_groups_);
  --open_groups_;
  body_ += "</g>\n";
}

std::string SvgDocument::Finish() const {
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n" + Element();
}

std::string SvgDocument::Element() const {
  PALPATE_CHECK(open_groups_ == 0, open_groups_);
  return head_ + "<defs>\n" + clips_ + "</defs>\n" + body_ + "</svg>\n";
}

std::string HexText(const Color& color) {
  static constexpr char kDigits[] = "0123456789abcdef";
  std::string text = "#";
  for (const double channel : {color.r, color.g, color.b}) {
    const int value = static_cast<int>(std::lround(255.0 * std::clamp(channel, 0.0, 1.0)));
    text += kDigits[value / 16];
    text += kDigits[value % 16];
  }
  return text;
}

std::string Base64(std::string_view bytes) {
  static constexpr char kDigits[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t at = 0; at < bytes.size(); at += 3) {
    const std::size_t here = std::min<std::size_t>(3, bytes.size() - at);
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      bits = bits << 8 | (k < here ? static_cast<std::uint8_t>(bytes[at + k]) : 0U);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += k <= here ? kDigits[bits >> (18 - 6 * k) & 63U] : '=';
    }
  }
  return text;
}

std::string EscapeXml(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&': escaped += "&amp;"; break;
      case '<': escaped += "&lt;"; break;
      case '>': escaped += "&gt;"; break;
      case '"': escaped += "&quot;"; break;
      default:
        const bool is_control = static_cast<unsigned char>(c) < 0x20 && c != '\t' && c != '\n';
        escaped += is_control ? std::string("\xEF\xBF\xBD") : std::string(1, c);
    }
  }
  return escaped;
}

}  // namespace palpate::plot
