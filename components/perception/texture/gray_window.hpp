// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <vector>

#include "libs/rgbd/image.hpp"
#include "libs/rgbd/surface_view.hpp"

namespace palpate::perception {

/// Brightness of a part of a colour image, grey levels, smoothed by a binomial of three pixels.
/// Pixels have the numbers that they have in the whole image.
class GrayWindow {
 public:
  /// Variance of white noise that the binomial leaves in a pixel, as a share.
  static constexpr float kNoiseLeft = 0.140625f;

  /// The part of `color` within `bounds` and `border_px` about them. Buffers are used again.
  void Take(const rgbd::ColorImage& color, const rgbd::SurfaceView::Bounds& bounds, int border_px);

  const rgbd::SurfaceView::Bounds& bounds() const { return bounds_; }
  /// Whether a square of this half side about the place lies within.
  bool Holds(float u_px, float v_px, float half_px) const;
  float At(int u_px, int v_px) const { return values_[Index(u_px, v_px)]; }
  /// Bilinear; at a place that Holds(u_px, v_px, 1).
  float Sample(float u_px, float v_px) const;

 private:
  std::size_t Index(int u_px, int v_px) const {
    return static_cast<std::size_t>(v_px - bounds_.v_begin) * width_ +
           static_cast<std::size_t>(u_px - bounds_.u_begin);
  }
  void Smooth();

  rgbd::SurfaceView::Bounds bounds_;
  std::size_t width_ = 0;
  std::vector<float> values_;
  std::vector<float> rows_;
};

}  // namespace palpate::perception
