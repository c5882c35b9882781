// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/model/background_planes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

namespace palpate::perception {
namespace {

using Points = std::vector<Eigen::Vector3f>;

const BackgroundPlanes::Tolerance kTolerance;

/// Of the plane z = `z_m` + `slope` y, `size_m` wide and high, with ripples of 1 mm.
Points Sheet(float z_m, float slope, float size_m) {
  Points points;
  constexpr int kSteps = 40;
  for (int i = 0; i < kSteps; ++i) {
    for (int j = 0; j < kSteps; ++j) {
      const float x = size_m * (static_cast<float>(i) / kSteps - 0.5f);
      const float y = size_m * (static_cast<float>(j) / kSteps - 0.5f);
      const float ripple = 1e-3f * std::sin(static_cast<float>(7 * i + 13 * j));
      points.emplace_back(x, y, z_m + slope * y + ripple);
    }
  }
  return points;
}

/// A body 0.2 m in size round `center_m`.
Points Body(const Eigen::Vector3f& center_m) {
  Points points = Sheet(0.0f, 0.5f, 0.2f);
  for (Eigen::Vector3f& point_m : points) point_m += center_m;
  return points;
}

TEST(BackgroundPlanes, HoldAWallBehindTheRobotAndWhatIsFartherAway) {
  BackgroundPlanes planes;
  planes.Update(Sheet(0.9f, -0.3f, 1.0f), Body({0.0f, 0.0f, 0.5f}), kTolerance);
  ASSERT_EQ(planes.planes().size(), 1u);
  EXPECT_NEAR(std::abs(planes.planes()[0].normal.z()), 1.0 / std::sqrt(1.09), 0.01);
  EXPECT_TRUE(planes.Holds({0.1f, 0.2f, 0.84f}, kTolerance));
  EXPECT_TRUE(planes.Holds({0.1f, 0.2f, 1.5f}, kTolerance));
  EXPECT_FALSE(planes.Holds({0.1f, 0.2f, 0.80f}, kTolerance));
}

TEST(BackgroundPlanes, AreNotBeforeTheRobot) {
  BackgroundPlanes planes;
  planes.Update(Sheet(0.4f, 0.0f, 1.0f), Body({0.0f, 0.0f, 0.6f}), kTolerance);
  EXPECT_TRUE(planes.planes().empty());
}

TEST(BackgroundPlanes, AreLargerThanTheRobot) {
  BackgroundPlanes planes;
  planes.Update(Sheet(0.9f, 0.0f, 0.15f), Body({0.0f, 0.0f, 0.5f}), kTolerance);
  EXPECT_TRUE(planes.planes().empty()) << "a plate that pushes from behind is an object";
}

TEST(BackgroundPlanes, ASmallerLeastSizeTakesAPlateForBackground) {
  BackgroundPlanes planes({.least_robot_sizes = 0.5f});
  planes.Update(Sheet(0.9f, 0.0f, 0.15f), Body({0.0f, 0.0f, 0.5f}), kTolerance);
  EXPECT_EQ(planes.planes().size(), 1u);
}

TEST(BackgroundPlanes, MayBeSmallerWhereTheRobotStandsOnThem) {
  const Points body = Body({0.0f, 0.0f, 0.5f});  // its feet are at z = 0.55
  for (const auto& [z_m, size_m, is_base] :
       {std::tuple(0.55f, 0.15f, true), std::tuple(0.55f, 0.05f, false),
        std::tuple(0.60f, 0.15f, false)}) {
    BackgroundPlanes planes;
    planes.Update(Sheet(z_m, 0.0f, size_m), body, kTolerance);
    EXPECT_EQ(planes.planes().size(), is_base ? 1u : 0u) << z_m << " m away, " << size_m << " m";
  }
}

TEST(BackgroundPlanes, FollowAPlaneFromFrameToFrame) {
  BackgroundPlanes planes;
  for (int frame = 0; frame < 30; ++frame) {
    const float z_m = 0.9f + 5e-4f * static_cast<float>(frame);
    planes.Update(Sheet(z_m, 0.0f, 1.0f), Body({0.0f, 0.0f, 0.5f}), kTolerance);
    ASSERT_EQ(planes.planes().size(), 1u) << frame;
    EXPECT_NEAR(-planes.planes()[0].offset_m, z_m, 5e-4);
  }
  planes.Update(Sheet(0.7f, 0.0f, 1.0f), Body({0.0f, 0.0f, 0.5f}), kTolerance);
  ASSERT_EQ(planes.planes().size(), 1u) << "moved at once, found at once";
  EXPECT_NEAR(-planes.planes()[0].offset_m, 0.7, 1e-3);
}

TEST(BackgroundPlanes, NeedPoints) {
  BackgroundPlanes planes;
  planes.Update({}, {}, kTolerance);
  EXPECT_TRUE(planes.planes().empty());
}

}  // namespace
}  // namespace palpate::perception
