// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "components/perception/markers/color_spots.hpp"

namespace palpate::perception {

/// A spot and the pixels round it.
struct SpotWindow {
  struct Pixel {
    Eigen::Vector2d at_px = Eigen::Vector2d::Zero();
    Eigen::Vector2d ray = Eigen::Vector2d::Zero();  ///< NaN where unknown
    double z_m = 0.0;                               ///< NaN: no depth
    Eigen::Vector3d rgb = Eigen::Vector3d::Zero();  ///< [0, 255]
    bool color_known = false;
    int distance_px = 0;  ///< from the spot, 0 in it; along rows, columns and diagonals
    double share = 0.0;   ///< of it that is marker, about [0, 1]
  };
  std::vector<Pixel> pixels;

  /// All pixels of the image no farther than `reach_px` from the spot. False where some would
  /// lie beyond the image's edge.
  bool Lay(const ColorSpot& spot, int reach_px, const RegisteredFrame& frame,
           const Registration& registration);
};

/// The colours that a window's pixels are mixed of.
struct SpotColors {
  Eigen::Vector3d marker = Eigen::Vector3d::Zero();
  Eigen::Vector3d around = Eigen::Vector3d::Zero();
  double contrast = 0.0;     ///< of their directions
  double share_sigma = 0.0;  ///< noise of a pixel's share
};

/// Pixels farther from a spot than this show nothing of it; those up to kRimEnd_px are its rim.
inline constexpr int kSpotReach_px = 2;
inline constexpr int kRimEnd_px = 4;

/// Sets the pixels' shares: of the two amounts of light that make up a pixel's colour, so that it
/// does not matter how brightly it is lit. The colour round the spot is that of the pixels of its
/// rim for which `on_skin` is set. False where there are too few of them.
bool Unmix(const std::vector<char>& on_skin, SpotWindow* window, SpotColors* colors);

}  // namespace palpate::perception
