// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "components/view/picture/color.hpp"

namespace palpate::view {

/// 8-bit image: rows from the top, three bytes (red, green, blue) a pixel.
struct Image {
  int width_px = 0;
  int height_px = 0;
  std::vector<std::uint8_t> rgb;  ///< 3 * width_px * height_px

  static Image Filled(int width_px, int height_px, const Color& color);

  std::uint8_t* Pixel(int x, int y) { return rgb.data() + Offset(x, y); }
  const std::uint8_t* Pixel(int x, int y) const { return rgb.data() + Offset(x, y); }

  /// Moves one pixel towards `color` by `opacity` in [0, 1].
  void Blend(int x, int y, const Color& color, double opacity);

 private:
  std::size_t Offset(int x, int y) const {
    return 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width_px) +
                static_cast<std::size_t>(x));
  }
};

/// The byte of a colour channel in [0, 1] (clamped).
std::uint8_t ToByte(double channel);

}  // namespace palpate::view
