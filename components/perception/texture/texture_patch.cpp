// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/texture/texture_patch.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace palpate::perception {

namespace {

constexpr int kPixels = TexturePatch::kSide_px * TexturePatch::kSide_px;

/// Offsets of the pixels from the centre, and weights that fall to the rim and add up to 1.
struct PatchGrid {
  Eigen::Matrix<float, 2, kPixels> offset_px;
  Eigen::Array<float, kPixels, 1> weight;

  PatchGrid() {
    constexpr float kSpread_px = 0.6f * TexturePatch::kHalf_px;
    for (int i = 0; i < kPixels; ++i) {
      offset_px(0, i) = static_cast<float>(i % TexturePatch::kSide_px - TexturePatch::kHalf_px);
      offset_px(1, i) = static_cast<float>(i / TexturePatch::kSide_px - TexturePatch::kHalf_px);
      weight[i] = std::exp(-0.5f * offset_px.col(i).squaredNorm() / (kSpread_px * kSpread_px));
    }
    weight /= weight.sum();
  }
};

const PatchGrid& Grid() {
  static const PatchGrid grid;
  return grid;
}

float Smallest(const Eigen::Matrix2f& symmetric) {
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix2f>(symmetric, Eigen::EigenvaluesOnly)
      .eigenvalues()[0];
}

}  // namespace

TexturePatch::TexturePatch(const GrayWindow& window, int u_px, int v_px) {
  const PatchGrid& grid = Grid();
  for (int i = 0; i < kPixels; ++i) {
    const int u = u_px + static_cast<int>(grid.offset_px(0, i));
    const int v = v_px + static_cast<int>(grid.offset_px(1, i));
    values_[i] = window.At(u, v);
    across_[i] = 0.5f * (window.At(u + 1, v) - window.At(u - 1, v));
    down_[i] = 0.5f * (window.At(u, v + 1) - window.At(u, v - 1));
  }
  values_ -= (grid.weight * values_).sum();
  variance_ = (grid.weight * values_.square()).sum();
  const auto mean_square = [this](const Pixels& weight) {
    Eigen::Matrix2f mean;
    mean(0, 0) = (weight * across_.square()).sum();
    mean(1, 1) = (weight * down_.square()).sum();
    mean(0, 1) = mean(1, 0) = (weight * across_ * down_).sum();
    return mean;
  };
  structure_ = mean_square(grid.weight);
  spread_ = mean_square(grid.weight.square());
}

float TexturePatch::Strength() const { return Smallest(structure_); }

bool TexturePatch::Read(const GrayWindow& window, const Eigen::Matrix2f& warp,
                        const Eigen::Vector2f& place_px, Pixels* image) const {
  const Eigen::Vector2f reach_px =
      static_cast<float>(kHalf_px) * warp.cwiseAbs().rowwise().sum() + Eigen::Vector2f::Ones();
  if (!window.Holds(place_px.x(), place_px.y(), reach_px.maxCoeff())) return false;
  const Eigen::Matrix<float, 2, kPixels> at_px = (warp * Grid().offset_px).colwise() + place_px;
  for (int i = 0; i < kPixels; ++i) (*image)[i] = window.Sample(at_px(0, i), at_px(1, i));
  return true;
}

TexturePatch::Comparison TexturePatch::Compare(const Pixels& image) const {
  const Pixels& weight = Grid().weight;
  const Pixels centred = image - (weight * image).sum();
  const float together = (weight * centred * values_).sum();
  const float variance = (weight * centred.square()).sum();
  Comparison comparison;
  comparison.gain = together / variance_;
  comparison.correlation = together / std::sqrt(variance_ * variance);
  comparison.left = centred - comparison.gain * values_;
  return comparison;
}

std::optional<FoundPatch> TexturePatch::Find(const GrayWindow& window, const Eigen::Matrix2f& warp,
                                             const Eigen::Vector2f& guess_px,
                                             const TexturePatchTuning& tuning) const {
  const Pixels& weight = Grid().weight;
  const Eigen::Matrix2f solve = warp * structure_.inverse();
  Eigen::Vector2f place_px = guess_px;
  Pixels image;
  for (int step = 0; step < tuning.most_steps; ++step) {
    if (!Read(window, warp, place_px, &image)) return std::nullopt;
    const Comparison comparison = Compare(image);
    if (!(comparison.gain > 0.0f)) return std::nullopt;
    const Eigen::Vector2f slope((weight * across_ * comparison.left).sum(),
                                (weight * down_ * comparison.left).sum());
    const Eigen::Vector2f step_px = solve * slope / comparison.gain;
    place_px -= step_px;
    if (!((place_px - guess_px).norm() < kHalf_px)) return std::nullopt;
    if (step_px.norm() >= tuning.step_at_rest_px) continue;
    if (comparison.correlation < tuning.least_correlation) return std::nullopt;
    const float noise2 = (weight * comparison.left.square()).sum() / GrayWindow::kNoiseLeft;
    const Eigen::Matrix2f left = solve / comparison.gain;
    const Eigen::Matrix2f covariance_px2 = noise2 * (left * spread_ * left.transpose());
    const float worst_px2 = covariance_px2.trace() - Smallest(covariance_px2);
    return FoundPatch{.place_px = place_px,
                      .sigma_px = std::hypot(std::sqrt(worst_px2), tuning.interpolation_sigma_px),
                      .correlation = comparison.correlation};
  }
  return std::nullopt;
}

}  // namespace palpate::perception
