// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/size_comparison.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>

namespace palpate::calibration {
namespace {

using testing::HasSubstr;

/// Corners of a cube of 20 mm: 17.32 mm from their middle.
Eigen::Matrix3Xd Corners() {
  Eigen::Matrix3Xd corners_m(3, 8);
  for (int k = 0; k < 8; ++k) corners_m.col(k) << (k & 1), ((k >> 1) & 1), ((k >> 2) & 1);
  return 0.02 * corners_m;
}

Eigen::Matrix3Xd Moved(const Eigen::Matrix3Xd& points_m) {
  const Eigen::AngleAxisd turn(1.1, Eigen::Vector3d(0.3, -0.8, 0.5).normalized());
  return (turn.toRotationMatrix() * points_m).colwise() + Eigen::Vector3d(0.3, -0.2, 0.4);
}

TEST(SizeComparison, DoesNotDependOnWherePointsAreButOnHowFarTheyAreApart) {
  SizeComparison same, larger;
  same.Add(Moved(Corners()), Corners());
  EXPECT_FALSE(same.Disagrees());
  EXPECT_NEAR(same.seen_m(), same.model_m(), 1e-15);
  larger.Add(Moved(1.3 * Corners()), Corners());
  larger.Add(1.3 * Corners(), Moved(Corners()));  // the pictures' middles differ
  EXPECT_TRUE(larger.Disagrees());
  EXPECT_THAT(larger.Text(),
              HasSubstr("22.52 mm from their centre (RMS), those of the model 17.32"));
  EXPECT_THAT(larger.Text(), HasSubstr("one 1.30 times"));
}

TEST(SizeComparison, ExplainsNoMoreThanItsDifferenceLeaves) {
  SizeComparison sizes;
  sizes.Add(1.3 * Corners(), Corners());
  EXPECT_TRUE(sizes.Explains(0.3 * 0.01732));
  EXPECT_FALSE(sizes.Explains(0.6 * 0.01732)) << "something else, too";
  EXPECT_FALSE(SizeComparison().Disagrees());
}

}  // namespace
}  // namespace palpate::calibration
