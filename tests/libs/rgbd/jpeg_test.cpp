// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/rgbd/jpeg.hpp"

#include <gmock/gmock.h>

#include <cstdio>
#include <cstdlib>
#include <string>

// It needs the types of <cstdio>.
#include <jpeglib.h>

#include "tests/support/test_folder.hpp"

namespace palpate::rgbd {
namespace {

using test_support::MessageOf;
using testing::HasSubstr;

/// A JPEG of the best quality; `channels` 1: grey, of red.
std::string Encode(const ColorImage& image, int channels) {
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

/// One colour, which JPEG keeps to a step or two.
ColorImage Plain(std::uint8_t red, std::uint8_t green, std::uint8_t blue) {
  ColorImage image(16, 8);
  for (int v = 0; v < image.height_px; ++v) {
    for (int u = 0; u < image.width_px; ++u) {
      image.Pixel(u, v)[0] = red;
      image.Pixel(u, v)[1] = green;
      image.Pixel(u, v)[2] = blue;
    }
  }
  return image;
}

TEST(Jpeg, ColoursKeepTheirOrder) {
  const ColorImage image = DecodeJpeg(Encode(Plain(200, 100, 50), 3), "name");
  ASSERT_EQ(image.width_px, 16);
  ASSERT_EQ(image.height_px, 8);
  EXPECT_NEAR(image.Pixel(7, 3)[0], 200, 3);
  EXPECT_NEAR(image.Pixel(7, 3)[1], 100, 3);
  EXPECT_NEAR(image.Pixel(7, 3)[2], 50, 3);
}

TEST(Jpeg, GreyBecomesRgb) {
  const ColorImage image = DecodeJpeg(Encode(Plain(120, 0, 0), 1), "name");
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(image.Pixel(0, 0)[c], 120, 2);
}

TEST(Jpeg, WhatIsNoWholeJpegIsRefusedByName) {
  const std::string whole = Encode(Plain(200, 100, 50), 3);
  EXPECT_THAT(MessageOf([] { DecodeJpeg("PNG", "name"); }), HasSubstr("name: is no JPEG image"));
  for (const std::size_t size : {std::size_t{4}, whole.size() / 2, whole.size() - 20}) {
    EXPECT_THAT(MessageOf([&] { DecodeJpeg(whole.substr(0, size), "name"); }),
                HasSubstr("name: is a damaged JPEG image: "))
        << size;
  }
}

}  // namespace
}  // namespace palpate::rgbd
