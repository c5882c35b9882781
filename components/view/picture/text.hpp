// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <string_view>
#include <vector>

#include "components/view/picture/overlay.hpp"

namespace palpate::view {

enum class Align { kLeft, kCenter, kRight };

/// Style of a line of text. Size is the height of a capital letter.
struct TextStyle {
  double capital_height_px = 12.0;
  Color color = palette::kInk;
  bool bold = false;
  Align align = Align::kLeft;
  double halo_px = 0.0;  ///< margin in the paper's colour around the letters
};

/// Width of a line of UTF-8 text in px.
double TextWidth(std::string_view text, const TextStyle& style);

/// Writes one line; `baseline_px` is the left, middle or right end of its baseline (by align).
/// Letters outside the image are cut off.
void DrawText(std::string_view text, const Eigen::Vector2d& baseline_px, const TextStyle& style,
              Image* image);

/// The characters of UTF-8 text; a byte that is not UTF-8 becomes U+FFFD.
std::vector<char32_t> DecodeUtf8(std::string_view text);

}  // namespace palpate::view
