// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/view/picture/text.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <numbers>

#include "components/view/picture/glyphs.hpp"

namespace palpate::view {

namespace {

constexpr double kLetterSpacing = 3.4;  // in the units of the glyphs
constexpr double kRegularWeight = 1.65;
constexpr double kBoldWeight = 2.5;

// Turns the strokes of a glyph into straight pieces, in the units of the glyph.
class StrokeWalker {
 public:
  explicit StrokeWalker(const char* strokes) : next_(strokes) {}

  template <typename Emit>
  void Walk(const Emit& emit) {
    while (*next_ != '\0') {
      switch (*next_++) {
        case 'M':
          pen_down_ = false;
          if (*next_ != 'A') {
            GoTo(ReadPoint(), emit);
          }
          break;
        case 'L': GoTo(ReadPoint(), emit); break;
        case 'C': Curve(emit); break;
        default: Arc(emit);
      }
    }
  }

 private:
  template <typename Emit>
  void GoTo(const Eigen::Vector2d& point, const Emit& emit) {
    if (pen_down_) {
      emit(at_, point);
    }
    at_ = point;
    pen_down_ = true;
  }

  template <typename Emit>
  void Curve(const Emit& emit) {
    constexpr int kPieces = 14;
    const Eigen::Vector2d p0 = at_;
    const Eigen::Vector2d p1 = ReadPoint();
    const Eigen::Vector2d p2 = ReadPoint();
    const Eigen::Vector2d p3 = ReadPoint();
    for (int i = 1; i <= kPieces; ++i) {
      const double t = static_cast<double>(i) / kPieces;
      const double s = 1.0 - t;
      GoTo(s * s * s * p0 + 3 * s * s * t * p1 + 3 * s * t * t * p2 + t * t * t * p3, emit);
    }
  }

  template <typename Emit>
  void Arc(const Emit& emit) {
    const Eigen::Vector2d center = ReadPoint();
    const Eigen::Vector2d radii = ReadPoint();
    const Eigen::Vector2d angles_deg = ReadPoint();
    const double sweep_deg = angles_deg.y() - angles_deg.x();
    const int pieces = 1 + static_cast<int>(std::abs(sweep_deg) / 9.0);
    for (int i = 0; i <= pieces; ++i) {
      const double angle = (angles_deg.x() + sweep_deg * i / pieces) * std::numbers::pi / 180.0;
      const Eigen::Vector2d offset(radii.x() * std::cos(angle), radii.y() * std::sin(angle));
      GoTo(center + offset, emit);
    }
  }

  double ReadNumber() {
    while (*next_ == ' ') {
      ++next_;
    }
    double number = 0.0;
    next_ = std::from_chars(next_, next_ + std::strlen(next_), number).ptr;
    return number;
  }

  Eigen::Vector2d ReadPoint() {
    const double x = ReadNumber();
    return {x, ReadNumber()};
  }

  const char* next_;
  Eigen::Vector2d at_ = Eigen::Vector2d::Zero();
  bool pen_down_ = false;
};

double Scale(const TextStyle& style) { return style.capital_height_px / kCapitalHeight; }

// Draws the strokes of a line into a mask, each widened by `margin_px` on all sides.
void AddLetters(const std::vector<char32_t>& letters, const Eigen::Vector2d& start_px,
                const TextStyle& style, double margin_px, CoverageMask* mask) {
  const double scale = Scale(style);
  const double weight = style.bold ? kBoldWeight : kRegularWeight;
  const double radius_px = std::max(0.5 * weight * scale, 0.5) + margin_px;
  double pen_px = start_px.x();
  for (const char32_t letter : letters) {
    const Glyph& glyph = FindGlyph(letter);
    const auto place = [&](const Eigen::Vector2d& p) {
      return Eigen::Vector2d(pen_px + scale * p.x(), start_px.y() - scale * p.y());
    };
    StrokeWalker(glyph.strokes).Walk([&](const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
      mask->AddStroke(place(from), place(to), radius_px);
    });
    pen_px += scale * (glyph.width + kLetterSpacing);
  }
}

}  // namespace

std::vector<char32_t> DecodeUtf8(std::string_view text) {
  constexpr char32_t kReplacement = 0xFFFD;
  std::vector<char32_t> letters;
  for (std::size_t i = 0; i < text.size();) {
    const auto lead = static_cast<unsigned char>(text[i]);
    const std::size_t length = lead < 0x80       ? 1
                               : lead >> 5 == 6  ? 2
                               : lead >> 4 == 14 ? 3
                               : lead >> 3 == 30 ? 4
                                                 : 0;
    if (length == 0 || i + length > text.size()) {
      letters.push_back(kReplacement);
      ++i;
      continue;
    }
    char32_t code = length == 1 ? lead : lead & (0xFFU >> (length + 1));
    for (std::size_t k = 1; k < length; ++k) {
      code = code << 6 | (static_cast<unsigned char>(text[i + k]) & 0x3FU);
    }
    letters.push_back(code);
    i += length;
  }
  return letters;
}

double TextWidth(std::string_view text, const TextStyle& style) {
  double width = 0.0;
  for (const char32_t letter : DecodeUtf8(text)) {
    width += FindGlyph(letter).width + kLetterSpacing;
  }
  return Scale(style) * std::max(0.0, width - kLetterSpacing);
}

void DrawText(std::string_view text, const Eigen::Vector2d& baseline_px, const TextStyle& style,
              Image* image) {
  const double width_px = TextWidth(text, style);
  const double share = style.align == Align::kLeft     ? 0.0
                       : style.align == Align::kCenter ? 0.5
                                                       : 1.0;
  const Eigen::Vector2d start_px = baseline_px - Eigen::Vector2d(share * width_px, 0.0);
  const double margin_px = style.halo_px + style.capital_height_px;
  const Rect box{start_px.x() - margin_px, start_px.y() - style.capital_height_px - margin_px,
                 width_px + 2.0 * margin_px, style.capital_height_px + 2.0 * margin_px};
  const std::vector<char32_t> letters = DecodeUtf8(text);
  if (style.halo_px > 0.0) {
    CoverageMask halo(box, *image);
    AddLetters(letters, start_px, style, style.halo_px, &halo);
    halo.Paint(palette::kPaper, 0.9, image);
  }
  CoverageMask ink(box, *image);
  AddLetters(letters, start_px, style, 0.0, &ink);
  ink.Paint(style.color, 1.0, image);
}

}  // namespace palpate::view
