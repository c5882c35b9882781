// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/model/rare_colors.hpp"

#include <gtest/gtest.h>

#include <array>
#include <utility>
#include <vector>

namespace palpate::perception {
namespace {

using Color = std::array<std::uint8_t, 3>;

constexpr Color kRed = {200, 60, 50};
constexpr Color kDarkRed = {50, 15, 12};
constexpr Color kBlue = {40, 80, 200};
constexpr Color kGreen = {40, 180, 80};

ColorModel::Histogram Counts(const std::vector<std::pair<Color, float>>& pixels) {
  const ColorModel model;
  ColorModel::Histogram counts(ColorModel::kBins, 0.0f);
  for (const auto& [rgb, count] : pixels) counts[model.BinOf(rgb.data())] += count;
  return counts;
}

bool IsRare(const RareColors& colors, const Color& rgb) {
  return colors.Hold(ColorModel().BinOf(rgb.data()));
}

TEST(RareColors, AreThoseOfFewPixels) {
  const RareColors colors(Counts({{kRed, 500.0f}, {kDarkRed, 300.0f}, {kBlue, 100.0f}}));
  EXPECT_FALSE(IsRare(colors, kRed));
  EXPECT_FALSE(IsRare(colors, kDarkRed)) << "shading makes no other colour";
  EXPECT_TRUE(IsRare(colors, kBlue));
  EXPECT_TRUE(IsRare(colors, kGreen)) << "not seen at all";
}

TEST(RareColors, ARobotMayHaveTwoColors) {
  const RareColors colors(Counts({{kRed, 500.0f}, {kBlue, 200.0f}}));
  EXPECT_FALSE(IsRare(colors, kRed));
  EXPECT_FALSE(IsRare(colors, kBlue));
}

TEST(RareColors, WhereNothingIsSeenNoneAreRare) {
  EXPECT_FALSE(IsRare(RareColors(), kRed));
  EXPECT_FALSE(IsRare(RareColors(Counts({})), kRed));
  const RareColors dark(Counts({{{0, 0, 0}, 500.0f}, {kBlue, 1.0f}}));
  EXPECT_FALSE(IsRare(dark, {0, 0, 0})) << "black has no chromaticity";
}

}  // namespace
}  // namespace palpate::perception
