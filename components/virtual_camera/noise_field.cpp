// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/virtual_camera/noise_field.hpp"

#include <cmath>

#include "libs/core/check.hpp"
#include "libs/core/index.hpp"

namespace palpate::virtual_camera {

namespace {

// White noise through exp(-k^2 / (2 s^2)) is correlated by exp(-d^2 / (4 s^2)), so s is half of the
// correlation length.
std::vector<float> GaussianWeights(double correlation_px) {
  const double s = 0.5 * correlation_px;
  const int radius = static_cast<int>(std::ceil(3.0 * s - 0.5));
  std::vector<double> weights;
  double squares = 0.0;
  for (int k = -radius; k <= radius; ++k) {
    weights.push_back(radius == 0 ? 1.0 : std::exp(-0.5 * k * k / (s * s)));
    squares += weights.back() * weights.back();
  }
  std::vector<float> scaled;
  for (const double weight : weights) {
    scaled.push_back(static_cast<float>(weight / std::sqrt(squares)));
  }
  return scaled;
}

}  // namespace

NoiseField::NoiseField(int width_px, int height_px, double correlation_px,
                       double temporal_correlation, const kernels::Kernels& loops)
    : loops_{loops},
      width_px_{width_px},
      height_px_{height_px},
      weights_{GaussianWeights(correlation_px)} {
  PALPATE_CHECK(correlation_px >= 0.0, correlation_px);
  PALPATE_CHECK(temporal_correlation >= 0.0 && temporal_correlation < 1.0, temporal_correlation);
  stride_ = (width_px + 2 * kernels::kRowPadding - 1) / kernels::kRowPadding * kernels::kRowPadding;
  old_share_ = static_cast<float>(temporal_correlation);
  fresh_share_ = static_cast<float>(std::sqrt(1.0 - temporal_correlation * temporal_correlation));
  const auto row = static_cast<std::size_t>(stride_);
  white_.assign(row + weights_.size() + kernels::kRowPadding, 0.0F);
  across_.assign(row * weights_.size(), 0.0F);
  fresh_.assign(row, 0.0F);
  state_.assign(row * static_cast<std::size_t>(height_px), 0.0F);
}

void NoiseField::Advance(std::uint64_t key) {
  const auto key_low = static_cast<std::uint32_t>(key);
  const auto key_high = static_cast<std::uint32_t>(key >> 32);
  const int white_width = width_px_ + taps() - 1;
  std::vector<const float*> rows(weights_.size());
  for (int v = 0; v < height_px_ + taps() - 1; ++v) {
    loops_.white_noise_row(key_low, key_high, static_cast<std::uint32_t>(v * white_width),
                           white_width, white_.data());
    for (int k = 0; k < taps(); ++k) rows[At(k)] = white_.data() + k;
    loops_.convolve(rows.data(), weights_.data(), taps(), width_px_, AcrossRow(v));
    const int done = v - taps() + 1;
    if (done < 0) continue;
    for (int k = 0; k < taps(); ++k) rows[At(k)] = AcrossRow(done + k);
    loops_.convolve(rows.data(), weights_.data(), taps(), width_px_, fresh_.data());
    loops_.blend_row(fresh_.data(), started_ ? old_share_ : 0.0F, started_ ? fresh_share_ : 1.0F,
                     width_px_, state_.data() + Offset(done));
  }
  started_ = true;
}

}  // namespace palpate::virtual_camera
