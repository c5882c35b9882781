// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/plot/text_width.hpp"

namespace palpate::plot {

namespace {

constexpr std::string_view kEllipsis = "\xE2\x80\xA6";
constexpr double kBold = 1.1;

bool ContinuesCharacter(char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; }

/// Advance of a character in parts of the text's size.
double Advance(char first_byte) {
  constexpr std::string_view kNarrow = "ijlI.,:;'| ", kSlim = "frt()[]-/\\\"!", kWide = "mMW@%";
  const auto is_in = [&](std::string_view set) {
    return set.find(first_byte) != std::string_view::npos;
  };
  if (is_in(kNarrow)) return 0.33;
  if (is_in(kSlim)) return 0.42;
  if (is_in(kWide)) return 0.98;
  const bool capital = first_byte >= 'A' && first_byte <= 'Z';
  const bool other_script = static_cast<unsigned char>(first_byte) >= 0x80U;
  if (capital || is_in("w")) return 0.8;
  return other_script || is_in("=+<>~") ? 0.9 : 0.64;
}

}  // namespace

double TextWidth_px(std::string_view text, double size_px, bool bold) {
  double width = 0.0;
  for (const char c : text) width += ContinuesCharacter(c) ? 0.0 : Advance(c);
  return width * size_px * (bold ? kBold : 1.0);
}

std::string Shortened(std::string_view text, double size_px, double width_px) {
  if (TextWidth_px(text, size_px) <= width_px) return std::string(text);
  while (!text.empty() &&
         TextWidth_px(text, size_px) + TextWidth_px(kEllipsis, size_px) > width_px) {
    text.remove_suffix(1);  // whole characters: all their width is in their first byte
  }
  return std::string(text) + std::string(kEllipsis);
}

}  // namespace palpate::plot
