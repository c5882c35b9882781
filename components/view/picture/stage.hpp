// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <vector>

#include "components/view/picture/camera.hpp"
#include "components/view/picture/rasteriser.hpp"
#include "components/view/picture/scene.hpp"

namespace palpate::view {

/// What must be inside the image.
std::vector<Extent> ExtentsOf(const Scene& scene);

/// Draws all that stands in space: floor and shadow, blocks, bodies, ghosts, cables, balls,
/// arrows. `px` is the size of a design pixel (1 in an image 960 px high).
void DrawStage(const Scene& scene, const Camera& camera, double px, Rasteriser* rasteriser);

/// A round step (1, 2 or 5 times a power of ten), the largest not above `value` > 0.
double RoundStepBelow(double value);

}  // namespace palpate::view
