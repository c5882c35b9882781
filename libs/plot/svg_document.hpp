// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "libs/plot/color.hpp"

namespace palpate::plot {

/// A point of the figure, pixels from the upper left corner.
struct SvgPoint {
  double x_px = 0.0;
  double y_px = 0.0;
};

/// How a line or a text is drawn.
struct SvgStroke {
  Color color = palette::kInk;
  double width_px = 1.0;
  bool dashed = false;
};

struct SvgText {
  enum class Anchor { kStart, kMiddle, kEnd };
  Anchor anchor = Anchor::kStart;
  double size_px = 12.0;
  Color color = palette::kInk;
  bool bold = false;
  double turned_deg = 0.0;  ///< anticlockwise
};

/// Writes a figure in SVG 1.1: well-formed XML, whatever the texts hold.
class SvgDocument {
 public:
  /// `name`: begins the ids inside, which must differ between the figures of one page.
  SvgDocument(int width_px, int height_px, const std::string& name = "");

  void Rectangle(const SvgPoint& corner, double width_px, double height_px, const Color& fill);
  void Line(const SvgPoint& from, const SvgPoint& to, const SvgStroke& stroke);
  /// At least two points.
  void Polyline(const std::vector<SvgPoint>& points, const SvgStroke& stroke);
  void Polygon(const std::vector<SvgPoint>& points, const Color& fill, double opacity);
  /// A polygon that leaves no hair line of the ground between itself and its neighbours.
  void Facet(const std::vector<SvgPoint>& points, const Color& fill);
  void Dot(const SvgPoint& center, double radius_px, const Color& fill);
  void Circle(const SvgPoint& center, double radius_px, const SvgStroke& stroke);
  /// A line that ends in a filled head of so many pixels; no longer than the arrow itself.
  void Arrow(const SvgPoint& from, const SvgPoint& to, double head_px, const SvgStroke& stroke);
  void Text(const SvgPoint& at, std::string_view text, const SvgText& style);

  /// A PNG file's bytes, stretched over the rectangle.
  void Image(const SvgPoint& corner, double width_px, double height_px, std::string_view png_bytes);

  /// What comes until EndGroup() is seen inside the rectangle only. `name`: its class.
  void BeginGroup(const std::string& name, const SvgPoint& corner, double width_px,
                  double height_px);
  void EndGroup();

  /// The whole file. No group may be open.
  std::string Finish() const;
  /// The svg element alone, to stand in a page of HTML. No group may be open.
  std::string Element() const;

 private:
  std::string name_;
  std::string head_;
  std::string clips_;
  std::string body_;
  int clip_count_ = 0;
  int open_groups_ = 0;
};

/// "#rrggbb"
std::string HexText(const Color& color);

/// Base 64 (RFC 4648) of some bytes.
std::string Base64(std::string_view bytes);

/// `text` as the content of an XML element or attribute; characters that XML does not know become
/// U+FFFD.
std::string EscapeXml(std::string_view text);

}  // namespace palpate::plot
