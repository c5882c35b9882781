// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/rgbd/ros_formats.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace palpate::rgbd {
namespace {

TEST(RosFormats, LensesOfPlumbBobAndTheRationalModelAreTakenAndOthersAreNot) {
  EXPECT_EQ(DistortionOf("plumb_bob", std::vector{0.1, 0.2, 0.3, 0.4}),
            (Distortion{0.1, 0.2, 0.3, 0.4}));
  EXPECT_EQ(
      DistortionOf("rational_polynomial", std::vector{0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8}),
      (Distortion{0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8}));
  EXPECT_EQ(DistortionOf("", {}), Distortion{});
  EXPECT_FALSE(DistortionOf("rational_polynomial", std::vector{0.1, 0.2, 0.3, 0.4, 0.5}));
  EXPECT_FALSE(DistortionOf("equidistant", std::vector{0.1, 0.2, 0.3, 0.4}));
}

TEST(RosFormats, NumbersThatAreNotFiniteAreNoLens) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(DistortionOf("plumb_bob", std::vector{0.1, nan, 0.0, 0.0, 0.0}));
}

TEST(RosFormats, ColoursAreFoundByTheirEncoding) {
  ASSERT_NE(ColorLayoutOf("bgra8"), nullptr);
  EXPECT_EQ(ColorLayoutOf("bgra8")->pixel_bytes, 4u);
  EXPECT_EQ(ColorLayoutOf("bgra8")->rgb[0], 2u);
  EXPECT_EQ(ColorLayoutOf("16UC1"), nullptr);
}

}  // namespace
}  // namespace palpate::rgbd
