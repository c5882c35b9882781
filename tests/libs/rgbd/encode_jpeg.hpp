// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

// It needs the types of <cstdio>.
#include <jpeglib.h>

#include "libs/rgbd/image.hpp"

namespace palpate::rgbd {

/// A JPEG of the best quality; `channels` 1: grey, of red.
inline std::string EncodeJpeg(const ColorImage& image, int channels) {
  jpeg_compress_struct jpeg{};
  jpeg_error_mgr errors{};
  jpeg.err = jpeg_std_error(&errors);
  jpeg_create_compress(&jpeg);
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&jpeg, &bytes, &size);
  jpeg.image_width = static_cast<JDIMENSION>(image.width_px);
  jpeg.image_height = static_cast<JDIMENSION>(image.height_px);
  jpeg.input_components = channels;
  jpeg.in_color_space = channels == 1 ? JCS_GRAYSCALE : JCS_RGB;
  jpeg_set_defaults(&jpeg);
  jpeg_set_quality(&jpeg, 100, TRUE);
  jpeg_start_compress(&jpeg, TRUE);
  for (int v = 0; v < image.height_px; ++v) {
    std::vector<JSAMPLE> row;
    for (int u = 0; u < image.width_px; ++u) {
      for (int c = 0; c < channels; ++c) row.push_back(image.Pixel(u, v)[c]);
    }
    JSAMPROW pointer = row.data();
    jpeg_write_scanlines(&jpeg, &pointer, 1);
  }
  jpeg_finish_compress(&jpeg);
  std::string encoded(reinterpret_cast<char*>(bytes), size);
  jpeg_destroy_compress(&jpeg);
  std::free(bytes);
  return encoded;
}

}  // namespace palpate::rgbd
