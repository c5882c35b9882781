// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace palpate::rgbd {

/// An image, rows from top to bottom, pixels from left to right, channels interleaved, no padding.
/// Pixel (0, 0) has its centre at u = v = 0.
template <typename T, int kChannels>
struct Image {
  static constexpr int channels = kChannels;

  int width_px = 0;
  int height_px = 0;
  std::vector<T> values;  ///< [height * width * channels]

  Image() = default;
  Image(int width, int height, T fill = {})
      : width_px(width),
        height_px(height),
        values(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * kChannels,
               fill) {}

  bool empty() const { return values.empty(); }
  T* Pixel(int u, int v) { return values.data() + Index(u, v); }
  const T* Pixel(int u, int v) const { return values.data() + Index(u, v); }
  bool operator==(const Image&) const = default;

 private:
  std::size_t Index(int u, int v) const {
    return (static_cast<std::size_t>(v) * static_cast<std::size_t>(width_px) +
            static_cast<std::size_t>(u)) *
           kChannels;
  }
};

using DepthImage = Image<std::uint16_t, 1>;  ///< z in steps of the camera's depth unit
using ColorImage = Image<std::uint8_t, 3>;   ///< RGB
using RangeImage = Image<float, 1>;          ///< z in m; NaN: nothing seen

}  // namespace palpate::rgbd
