// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "components/capture/decode/image_part.hpp"
#include "libs/core/status.hpp"
#include "libs/rgbd/image.hpp"

namespace palpate::capture {

/// Turns the pixels of an intensity image into RGB: RGB8, BGR8, RGBa8, BGRa8, Mono8, Mono16 (its
/// upper byte), BayerRG8/GR8/GB8/BG8 (bilinear), the Y of Coord3D_ABCY16 (its upper byte). Ok, or
/// kInvalidInput with the reason; then the image is not to be used. Allocates nothing where the
/// image has its size already; reads no byte beyond the part's size.
Status DecodeColor(const ImagePart& part, rgbd::ColorImage* image);

}  // namespace palpate::capture
