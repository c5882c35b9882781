// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/texture/gray_window.hpp"

#include <algorithm>
#include <cmath>

namespace palpate::perception {

namespace {

/// Of the luma of Rec. 601.
float Brightness(const std::uint8_t* rgb) {
  return 0.299f * static_cast<float>(rgb[0]) + 0.587f * static_cast<float>(rgb[1]) +
         0.114f * static_cast<float>(rgb[2]);
}

}  // namespace

void GrayWindow::Take(const rgbd::ColorImage& color, const rgbd::SurfaceView::Bounds& bounds,
                      int border_px) {
  bounds_ = {.u_begin = std::max(0, bounds.u_begin - border_px),
             .v_begin = std::max(0, bounds.v_begin - border_px),
             .u_end = std::min(color.width_px, bounds.u_end + border_px),
             .v_end = std::min(color.height_px, bounds.v_end + border_px)};
  if (bounds.empty()) bounds_ = {};
  width_ = static_cast<std::size_t>(bounds_.u_end - bounds_.u_begin);
  values_.resize(width_ * static_cast<std::size_t>(bounds_.v_end - bounds_.v_begin));
  for (int v = bounds_.v_begin; v < bounds_.v_end; ++v) {
    for (int u = bounds_.u_begin; u < bounds_.u_end; ++u) {
      values_[Index(u, v)] = Brightness(color.Pixel(u, v));
    }
  }
  Smooth();
}

/// Along the rows, then along the columns; at the rim the last pixel counts twice.
void GrayWindow::Smooth() {
  const std::size_t height = width_ > 0 ? values_.size() / width_ : 0;
  const auto blend = [](float before, float here, float after) {
    return 0.25f * before + 0.5f * here + 0.25f * after;
  };
  rows_.resize(values_.size());
  for (std::size_t v = 0; v < height; ++v) {
    const float* row = values_.data() + v * width_;
    for (std::size_t u = 0; u < width_; ++u) {
      rows_[v * width_ + u] =
          blend(row[u > 0 ? u - 1 : 0], row[u], row[std::min(u + 1, width_ - 1)]);
    }
  }
  for (std::size_t v = 0; v < height; ++v) {
    const float* above = rows_.data() + (v > 0 ? v - 1 : 0) * width_;
    const float* here = rows_.data() + v * width_;
    const float* below = rows_.data() + std::min(v + 1, height - 1) * width_;
    for (std::size_t u = 0; u < width_; ++u) {
      values_[v * width_ + u] = blend(above[u], here[u], below[u]);
    }
  }
}

bool GrayWindow::Holds(float u_px, float v_px, float half_px) const {
  return u_px - half_px >= static_cast<float>(bounds_.u_begin) &&
         v_px - half_px >= static_cast<float>(bounds_.v_begin) &&
         u_px + half_px < static_cast<float>(bounds_.u_end - 1) &&
         v_px + half_px < static_cast<float>(bounds_.v_end - 1);
}

float GrayWindow::Sample(float u_px, float v_px) const {
  const float u = std::floor(u_px);
  const float v = std::floor(v_px);
  const float right = u_px - u;
  const float down = v_px - v;
  const float* at = values_.data() + Index(static_cast<int>(u), static_cast<int>(v));
  const float above = at[0] + right * (at[1] - at[0]);
  const float below = at[width_] + right * (at[width_ + 1] - at[width_]);
  return above + down * (below - above);
}

}  // namespace palpate::perception
