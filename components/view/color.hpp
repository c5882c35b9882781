// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

namespace palpate::view {

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

namespace palette {
inline constexpr Color kPaper = FromHex(0xFFFFFF);
inline constexpr Color kInk = FromHex(0x1F2933);
inline constexpr Color kMutedInk = FromHex(0x66727F);
inline constexpr Color kRule = FromHex(0xC9D1D9);
inline constexpr Color kFloorLine = FromHex(0xDFE4E9);
inline constexpr Color kShadow = FromHex(0xEDF0F3);
inline constexpr Color kGhost = FromHex(0x8A97A5);
inline constexpr Color kClamp = FromHex(0xAEB8C2);
inline constexpr Color kSilicone = FromHex(0xC3D3E0);
inline constexpr Color kCable = FromHex(0x2B3A4A);
inline constexpr Color kEstimate = FromHex(0xC8102E);  ///< estimated forces
inline constexpr Color kTruth = FromHex(0x1D6FB8);     ///< known forces
inline constexpr Color kMarker = FromHex(0xF28E2B);    ///< observed points
inline constexpr Color kModelPoint = FromHex(0x111820);
inline constexpr Color kAxisX = FromHex(0xC0392B);
inline constexpr Color kAxisY = FromHex(0x2E8B57);
inline constexpr Color kAxisZ = FromHex(0x2F5FB3);
}  // namespace palette

}  // namespace palpate::view
