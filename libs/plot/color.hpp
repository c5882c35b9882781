// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

namespace palpate::plot {

/// Red, green, blue, each in [0, 1], sRGB-coded.
struct Color {
  double r = 0.0;
  double g = 0.0;
  double b = 0.0;
};

/// A colour from 0xRRGGBB.
constexpr Color FromHex(unsigned rgb) {
  return {((rgb >> 16) & 0xFF) / 255.0, ((rgb >> 8) & 0xFF) / 255.0, (rgb & 0xFF) / 255.0};
}

/// `a` at t = 0, `b` at t = 1, straight in between.
Color Mix(const Color& a, const Color& b, double t);

/// The colour of a quantity without sign: t in [0, 1] (clamped) from indigo (small) over teal and
/// green to yellow (large). Lightness rises all the way, so it reads in grey and with any colour
/// vision.
Color SequentialColor(double t);

/// Background and text colours of every figure.
namespace palette {
inline constexpr Color kPaper = FromHex(0xFFFFFF);
inline constexpr Color kInk = FromHex(0x1F2933);
inline constexpr Color kMutedInk = FromHex(0x66727F);
inline constexpr Color kRule = FromHex(0xC9D1D9);
inline constexpr Color kGridLine = FromHex(0xDFE4E9);
}  // namespace palette

}  // namespace palpate::plot
