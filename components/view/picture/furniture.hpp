// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <vector>

#include "components/view/picture/camera.hpp"
#include "components/view/picture/image.hpp"
#include "components/view/picture/rasteriser.hpp"
#include "components/view/picture/scene.hpp"

namespace palpate::view {

/// The page around the stage: what stands where. `px` is the size of a design pixel.
struct PageLayout {
  double px = 1.0;
  Rect stage;      ///< for the things in space and their labels
  Rect color_bar;  ///< the bar itself
  int legend_rows = 0;
};

PageLayout LayOutPage(const Scene& scene);

/// Title, caption, colour bar, legend, axes and (orthographic) scale bar.
void DrawFurniture(const Scene& scene, const PageLayout& page, const Camera& camera, Image* image);

/// Crosses of model points and the labels of the arrows, beside the arrows and off the drawing.
void DrawAnnotations(const Scene& scene, const PageLayout& page, const Camera& camera,
                     const Rasteriser& stage, Image* image);

}  // namespace palpate::view
