// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "components/perception/texture/gray_window.hpp"

namespace palpate::perception {

struct TexturePatchTuning {
  int most_steps = 12;  ///< of Gauss and Newton; more: from farther, slower
  float step_at_rest_px = 0.01f;
  /// Correlation with the patch, below which it shows something else. Smaller: wrong places;
  /// larger: points are lost where the light changes.
  float least_correlation = 0.8f;
  /// Standard deviation of what interpolation and facets add to a place. Smaller: trusted more than
  /// it deserves.
  float interpolation_sigma_px = 0.04f;
};

/// Where a patch was found.
struct FoundPatch {
  Eigen::Vector2f place_px = Eigen::Vector2f::Zero();
  float sigma_px = 0.0f;  ///< of each component, in the direction that is told worst
  float correlation = 0.0f;
};

/// A square of an image about a point of texture, as it was when it was first seen. It is found
/// again by the inverse compositional method of Lucas and Kanade (Baker and Matthews 2004): the
/// patch is warped as the surface is known to have turned, its gain and brightness are free, and
/// its place is estimated. Every frame is compared with the first image, so nothing drifts.
class TexturePatch {
 public:
  static constexpr int kHalf_px = 7;
  static constexpr int kSide_px = 2 * kHalf_px + 1;

  /// `window` must hold the patch with one more pixel on each side.
  TexturePatch(const GrayWindow& window, int u_px, int v_px);

  /// Squared gradient in the weakest direction, grey levels^2 per px^2: what tells its place.
  float Strength() const;

  /// Finds it near `guess_px`. `warp`: derivative of a place in this image by one in the first.
  /// Nothing where it is not found, or leaves the window.
  std::optional<FoundPatch> Find(const GrayWindow& window, const Eigen::Matrix2f& warp,
                                 const Eigen::Vector2f& guess_px,
                                 const TexturePatchTuning& tuning) const;

 private:
  using Pixels = Eigen::Array<float, kSide_px * kSide_px, 1>;
  struct Comparison {
    float gain = 0.0f;
    float correlation = 0.0f;
    Pixels left;  ///< image - gain * patch - brightness
  };

  bool Read(const GrayWindow& window, const Eigen::Matrix2f& warp, const Eigen::Vector2f& place_px,
            Pixels* image) const;
  Comparison Compare(const Pixels& image) const;

  Pixels values_;  ///< less their mean
  Pixels across_;  ///< gradients
  Pixels down_;
  float variance_ = 0.0f;
  Eigen::Matrix2f structure_;  ///< weighted mean of the gradient's square
  Eigen::Matrix2f spread_;     ///< the same with squared weights: for noise of one pixel
};

}  // namespace palpate::perception
