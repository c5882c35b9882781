// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/model/color_model.hpp"

#include <gtest/gtest.h>

namespace palpate::perception {
namespace {

constexpr std::uint8_t kRed[3] = {200, 70, 60};
constexpr std::uint8_t kDimRed[3] = {100, 35, 30};
constexpr std::uint8_t kBrown[3] = {115, 84, 56};
constexpr std::uint8_t kGreen[3] = {40, 160, 80};
constexpr std::uint8_t kWhite[3] = {255, 255, 255};
constexpr std::uint8_t kBlack[3] = {3, 2, 4};

ColorModel::Histogram Of(const ColorModel& model, const std::uint8_t* rgb, float count) {
  ColorModel::Histogram histogram(ColorModel::kBins, 0.0f);
  histogram[model.BinOf(rgb)] = count;
  return histogram;
}

TEST(ColorModel, SaysNothingBeforeItHasLearnt) {
  const ColorModel model;
  EXPECT_FALSE(model.initialised());
  EXPECT_EQ(model.LogRatio(model.BinOf(kRed)), 0.0f);
}

TEST(ColorModel, TellsWhatItHasLearntAndNothingOfOtherColors) {
  ColorModel model;
  model.Update(Of(model, kRed, 900.0f), Of(model, kBrown, 5000.0f), 0.1);
  EXPECT_GT(model.LogRatio(model.BinOf(kRed)), 2.0f);
  EXPECT_LT(model.LogRatio(model.BinOf(kBrown)), -2.0f);
  EXPECT_EQ(model.LogRatio(model.BinOf(kGreen)), 0.0f);
  EXPECT_EQ(model.LogRatio(ColorModel::kNoColor), 0.0f);
}

TEST(ColorModel, LearnsSlowlyWhatIsNew) {
  ColorModel model;
  model.Update(Of(model, kRed, 900.0f), Of(model, kGreen, 5000.0f), 0.1);
  float last = model.LogRatio(model.BinOf(kGreen));
  for (int frame = 0; frame < 5; ++frame) {
    model.Update(Of(model, kGreen, 900.0f), Of(model, kBrown, 5000.0f), 0.1);
    EXPECT_GT(model.LogRatio(model.BinOf(kGreen)), last);
    last = model.LogRatio(model.BinOf(kGreen));
  }
  EXPECT_LT(last, 0.0f) << "five tenths of a frame do not turn it round";
}

TEST(ColorModel, FindsAnotherLightUnlike) {
  ColorModel model;
  model.Update(Of(model, kRed, 900.0f), Of(model, kBrown, 5000.0f), 0.1);
  EXPECT_GT(model.Similarity(Of(model, kRed, 10.0f)), 0.99);
  EXPECT_LT(model.Similarity(Of(model, kDimRed, 10.0f)), 0.5);
  model.Forget();
  EXPECT_FALSE(model.initialised());
}

TEST(ColorModel, SeesNoColorInBlackOrWhite) {
  const ColorModel model;
  EXPECT_EQ(model.BinOf(kWhite), ColorModel::kNoColor);
  EXPECT_EQ(model.BinOf(kBlack), ColorModel::kNoColor);
  EXPECT_NE(model.BinOf(kRed), ColorModel::kNoColor);
  EXPECT_EQ(model.BinOf(kRed) % (ColorModel::kChromaBins * ColorModel::kChromaBins),
            model.BinOf(kDimRed) % (ColorModel::kChromaBins * ColorModel::kChromaBins))
      << "half the light, the same chromaticity";
}

TEST(ColorModel, AssumesAColorInAnyBrightness) {
  ColorModel model;
  model.Assume({0.85, 0.30, 0.25});
  EXPECT_TRUE(model.initialised());
  EXPECT_GT(model.LogRatio(model.BinOf(kRed)), 1.0f);
  EXPECT_GT(model.LogRatio(model.BinOf(kDimRed)), 1.0f);
  EXPECT_LT(model.LogRatio(model.BinOf(kGreen)), -0.5f);
}

}  // namespace
}  // namespace palpate::perception
