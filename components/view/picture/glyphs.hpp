// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

namespace palpate::view {

/// A character as pen strokes. Heights: baseline 0, small letters 10, capitals 14, descenders -4;
/// the left edge is x = 0. Strokes are a path of numbers after one letter each:
///   M x y  lift the pen and go there        L x y  straight line
///   C x1 y1 x2 y2 x y  cubic Bezier curve   A cx cy rx ry from_deg to_deg  arc of an ellipse
/// An arc that follows M or stands first starts where it starts; else a line leads to it.
struct Glyph {
  char32_t code;
  double width;
  const char* strokes;
};

inline constexpr double kCapitalHeight = 14.0;

/// The glyph of a character; of one that is not drawn, an open box.
const Glyph& FindGlyph(char32_t code);

}  // namespace palpate::view
