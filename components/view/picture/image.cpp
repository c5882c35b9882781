// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/view/picture/image.hpp"

#include <algorithm>
#include <cmath>

namespace palpate::view {

std::uint8_t ToByte(double channel) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(channel, 0.0, 1.0) * 255.0));
}

Image Image::Filled(int width_px, int height_px, const Color& color) {
  Image image{width_px, height_px, {}};
  image.rgb.resize(3 * static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px));
  for (std::size_t i = 0; i < image.rgb.size(); i += 3) {
    image.rgb[i] = ToByte(color.r);
    image.rgb[i + 1] = ToByte(color.g);
    image.rgb[i + 2] = ToByte(color.b);
  }
  return image;
}

void Image::Blend(int x, int y, const Color& color, double opacity) {
  std::uint8_t* pixel = Pixel(x, y);
  const double channels[3] = {color.r, color.g, color.b};
  for (int c = 0; c < 3; ++c) {
    const double old = pixel[c] / 255.0;
    pixel[c] = ToByte(old + (channels[c] - old) * opacity);
  }
}

}  // namespace palpate::view
