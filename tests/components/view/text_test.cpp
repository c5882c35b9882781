// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/view/picture/text.hpp"

#include <gtest/gtest.h>

#include "components/view/picture/glyphs.hpp"

namespace palpate::view {
namespace {

struct InkBox {
  int left = 1 << 20, right = -1, top = 1 << 20, bottom = -1;
  bool empty() const { return right < 0; }
};

InkBox FindInk(const Image& image) {
  InkBox box;
  for (int y = 0; y < image.height_px; ++y) {
    for (int x = 0; x < image.width_px; ++x) {
      if (image.Pixel(x, y)[0] < 200) {
        box.left = std::min(box.left, x);
        box.right = std::max(box.right, x);
        box.top = std::min(box.top, y);
        box.bottom = std::max(box.bottom, y);
      }
    }
  }
  return box;
}

TEST(Text, DrawsEveryPrintableAsciiCharacterInsideItsCell) {
  for (char c = '!'; c <= '~'; ++c) {
    Image image = Image::Filled(100, 100, palette::kPaper);
    const TextStyle style{.capital_height_px = 28.0};
    DrawText({&c, 1}, {30, 60}, style, &image);
    const InkBox ink = FindInk(image);
    ASSERT_FALSE(ink.empty()) << c;
    EXPECT_NE(FindGlyph(static_cast<char32_t>(c)).code, 0U) << c;
    EXPECT_GE(ink.left, 27) << c;
    EXPECT_LE(ink.right, 30 + TextWidth({&c, 1}, style) + 3) << c;
    EXPECT_GE(ink.top, 60 - 35) << c;
    EXPECT_LE(ink.bottom, 60 + 11) << c;
  }
}

TEST(Text, IsAsHighAsAskedFor) {
  Image image = Image::Filled(100, 100, palette::kPaper);
  DrawText("H", {20, 70}, {.capital_height_px = 40.0}, &image);
  const InkBox ink = FindInk(image);
  EXPECT_NEAR(ink.bottom - ink.top, 40.0 * (1.0 + kCapitalHeight / 14.0 * 0.118), 2.0);
}

TEST(Text, AlignsLeftCenterAndRight) {
  const TextStyle left{.align = Align::kLeft};
  TextStyle center = left;
  center.align = Align::kCenter;
  TextStyle right = left;
  right.align = Align::kRight;
  const double width = TextWidth("force", left);
  for (const auto& [style, start] :
       {std::pair{left, 100.0}, {center, 100.0 - width / 2}, {right, 100.0 - width}}) {
    Image image = Image::Filled(200, 40, palette::kPaper);
    DrawText("force", {100, 30}, style, &image);
    EXPECT_NEAR(FindInk(image).left, start, 1.5);
    EXPECT_NEAR(FindInk(image).right, start + width, 1.5);
  }
}

TEST(Text, CutsOffOutsideThePicture) {
  Image image = Image::Filled(20, 20, palette::kPaper);
  DrawText("much too long for this", {-5, 3}, {.halo_px = 3.0}, &image);
  DrawText("far away", {500, 900}, {}, &image);
  EXPECT_EQ(image.rgb.size(), 1200U);
}

TEST(Text, DecodesUtf8AndReplacesWhatIsNot) {
  EXPECT_EQ(DecodeUtf8("a\u00B1\u2248"), (std::vector<char32_t>{U'a', 0xB1, 0x2248}));
  EXPECT_EQ(DecodeUtf8("\xFFz"), (std::vector<char32_t>{0xFFFD, U'z'}));
  EXPECT_EQ(DecodeUtf8("\xE2\x89"), (std::vector<char32_t>{0xFFFD, 0xFFFD}));
  EXPECT_EQ(FindGlyph(0x2603).code, 0U);
}

TEST(Text, MakesBoldDarkerAndNotWider) {
  const auto darkness = [](bool bold) {
    Image image = Image::Filled(200, 40, palette::kPaper);
    DrawText("palpate", {10, 30}, {.bold = bold}, &image);
    long sum = 0;
    for (const auto byte : image.rgb) {
      sum += 255 - byte;
    }
    return sum;
  };
  EXPECT_GT(darkness(true), 1.2 * static_cast<double>(darkness(false)));
}

}  // namespace
}  // namespace palpate::view
