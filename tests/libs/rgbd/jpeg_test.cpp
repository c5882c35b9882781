// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/rgbd/jpeg.hpp"

#include <gmock/gmock.h>

#include <cstdint>
#include <string>

#include "libs/core/error.hpp"
#include "tests/support/test_folder.hpp"

namespace palpate::rgbd {
namespace {

using test_support::MessageOf;
using testing::HasSubstr;

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
  const ColorImage image = DecodeJpeg(EncodeJpeg(Plain(200, 100, 50), 100), "name");
  ASSERT_EQ(image.width_px, 16);
  ASSERT_EQ(image.height_px, 8);
  EXPECT_NEAR(image.Pixel(7, 3)[0], 200, 3);
  EXPECT_NEAR(image.Pixel(7, 3)[1], 100, 3);
  EXPECT_NEAR(image.Pixel(7, 3)[2], 50, 3);
}

TEST(Jpeg, GreyBecomesRgb) {
  const ColorImage image = DecodeJpeg(EncodeJpeg(GreyImage(16, 8, 120), 100), "name");
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(image.Pixel(0, 0)[c], 120, 2);
}

TEST(Jpeg, LowerQualityIsSmaller) {
  ColorImage noise(64, 64);
  unsigned state = 1;
  for (std::uint8_t& value : noise.values) {
    state = state * 1664525U + 1013904223U;
    value = static_cast<std::uint8_t>(state >> 24);
  }
  EXPECT_LT(EncodeJpeg(noise, 30).size(), EncodeJpeg(noise, 90).size());
  EXPECT_EQ(DecodeJpeg(EncodeJpeg(noise, 30), "name").height_px, 64);
}

TEST(Jpeg, NoneIsMadeOfNoPixels) {
  const auto refusal = [](const auto& image) {
    return MessageOf<RunError>([&] { EncodeJpeg(image, 75); });
  };
  EXPECT_THAT(refusal(ColorImage()), HasSubstr("0 x 0"));
  EXPECT_THAT(refusal(GreyImage(5, 0)), HasSubstr("5 x 0"));
}

TEST(Jpeg, WhatIsNoWholeJpegIsRefusedByName) {
  const std::string whole = EncodeJpeg(Plain(200, 100, 50), 100);
  EXPECT_THAT(MessageOf([] { DecodeJpeg("PNG", "name"); }), HasSubstr("name: is no JPEG image"));
  for (const std::size_t size : {std::size_t{4}, whole.size() / 2, whole.size() - 20}) {
    EXPECT_THAT(MessageOf([&] { DecodeJpeg(whole.substr(0, size), "name"); }),
                HasSubstr("name: is a damaged JPEG image: "))
        << size;
  }
}

}  // namespace
}  // namespace palpate::rgbd
