// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <vector>

#include "components/virtual_camera/kernels/kernels.hpp"

namespace palpate::virtual_camera {

/// Normally distributed numbers, mean 0, variance 1, one for each pixel. Correlation at the
/// distance d in the image is exp(-(d / correlation_px)^2), from one frame to the next
/// `temporal_correlation` (first order).
class NoiseField {
 public:
  /// correlation_px >= 0; temporal_correlation in [0, 1). `loops` must outlive this.
  NoiseField(int width_px, int height_px, double correlation_px, double temporal_correlation,
             const kernels::Kernels& loops);

  /// The next frame; `key` makes its fresh part. Rows can be had in any order.
  void Advance(std::uint64_t key);
  const float* Row(int v) const { return state_.data() + Offset(v); }  ///< padded

 private:
  std::size_t Offset(int v) const {
    return static_cast<std::size_t>(v) * static_cast<std::size_t>(stride_);
  }
  float* AcrossRow(int v) { return across_.data() + Offset(v % taps()); }
  int taps() const { return static_cast<int>(weights_.size()); }

  const kernels::Kernels& loops_;
  int width_px_;
  int height_px_;
  int stride_;
  std::vector<float> weights_;  // of one direction; the squares' sum is 1
  float old_share_;
  float fresh_share_;
  bool started_ = false;
  std::vector<float> white_;   // one row, with room for the taps
  std::vector<float> across_;  // the last rows, correlated across
  std::vector<float> fresh_;   // one row
  std::vector<float> state_;   // [height][stride]
};

}  // namespace palpate::virtual_camera
