// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstddef>
#include <cstdint>

#include "components/capture/genicam/pixel_format.hpp"

namespace palpate::capture {

/// One image inside a buffer as it came from the camera; nothing of it is to be trusted.
struct ImagePart {
  const std::uint8_t* data = nullptr;
  std::size_t size_bytes = 0;
  PixelFormat format = PixelFormat::kUnknown;
  int width_px = 0;
  int height_px = 0;
  int row_padding_bytes = 0;
  std::uint32_t component_id =
      0;  ///< SFNC: 1 Intensity, 4 Range, 6 Confidence, 8 Disparity; 0: none
};

inline constexpr int kGreatestImageSide_px = 16384;

/// Bytes from row to row; 0 where the part cannot be read: no or absurd size, an unknown format, or
/// fewer bytes than it would need.
std::size_t RowStep(const ImagePart& part);

}  // namespace palpate::capture
