// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/capture/decode/image_part.hpp"

namespace palpate::capture {

std::size_t RowStep(const ImagePart& part) {
  const std::size_t pixel_bytes = BytesPerPixel(part.format);
  if (part.data == nullptr || pixel_bytes == 0 || part.width_px <= 0 || part.height_px <= 0 ||
      part.width_px > kGreatestImageSide_px || part.height_px > kGreatestImageSide_px ||
      part.row_padding_bytes < 0 || part.row_padding_bytes > kGreatestImageSide_px) {
    return 0;
  }
  const std::size_t row = pixel_bytes * static_cast<std::size_t>(part.width_px);
  const std::size_t step = row + static_cast<std::size_t>(part.row_padding_bytes);
  const std::size_t needed = step * static_cast<std::size_t>(part.height_px - 1) + row;
  return needed <= part.size_bytes ? step : 0;
}

}  // namespace palpate::capture
