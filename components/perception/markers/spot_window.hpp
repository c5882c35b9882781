// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "components/perception/markers/color_spots.hpp"

namespace palpate::perception {

/// A spot and the pixels around it.
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

/// The colours whose mixtures are a window's pixels.
struct SpotColors {
  Eigen::Vector3d marker = Eigen::Vector3d::Zero();
  Eigen::Vector3d around = Eigen::Vector3d::Zero();
  double contrast = 0.0;     ///< of their directions
  double share_sigma = 0.0;  ///< noise of a pixel's share
};

struct SpotWindowTuning {
  /// Reach of the blur: pixels farther from a spot have no share of it; those up to rim_end_px are
  /// its rim. Larger: other surfaces enter the colour of the surroundings.
  int spot_reach_px = 2;
  int rim_end_px = 4;
  std::size_t least_rim_px = 4;  ///< pixels on the surface; fewer: a random colour
  /// Brightness over that of the marker below which surroundings have no colour. Larger: brightness
  /// instead of colour gives the shares.
  double dark_share = 0.12;
  double share_slack = 0.3;  ///< shares are within [-slack, 1 + slack]; larger: noise moves centres
  /// Share of the largest share from which a pixel gives the marker's own colour. Smaller: blurred
  /// pixels do, too.
  double pure_share = 0.85;
  int rounds = 3;  ///< of colour and shares; more: slower, a more exact colour
};

/// Sets the pixels' shares: of the two amounts of light in a pixel's colour, which makes them
/// independent of its brightness. The surrounding colour is that of the pixels of the spot's rim
/// for which `on_surface` is set. False where there are too few of them.
bool Unmix(const std::vector<char>& on_surface, SpotWindow* window, SpotColors* colors,
           const SpotWindowTuning& tuning = {});

}  // namespace palpate::perception
