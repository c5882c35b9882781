// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "components/perception/texture/gray_window.hpp"
#include "libs/rgbd/surface_view.hpp"

namespace palpate::perception {

struct TextureSeedsTuning {
  /// Mean gradient in the weakest direction from which texture is worth following. Smaller: more
  /// points that are soon lost; larger: weak texture is not used.
  float least_gradient = 1.0f;  ///< grey levels per px
  /// Step of z within a patch beyond which it shows two surfaces. Larger: points at the robot's
  /// rim, which move with the background; smaller: slanted surfaces have none.
  float largest_step_m = 16e-3f;
  int step_px = 3;  ///< of the places that are compared; larger: faster, weaker texture
};

/// Places of the image at which points of texture may be followed: the strongest corner (Shi and
/// Tomasi 1994) of each cell of a grid over the drawn surface, cells that hold one of `taken_px`
/// aside. About `most` cells share the surface, none smaller than a patch.
std::vector<Eigen::Vector2i> SeedPlaces_px(const GrayWindow& window, const rgbd::SurfaceView& view,
                                           const std::vector<Eigen::Vector2d>& taken_px, int most,
                                           const TextureSeedsTuning& tuning = {});

}  // namespace palpate::perception
