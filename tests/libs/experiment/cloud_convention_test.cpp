// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/experiment/cloud/cloud_convention.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <utility>

namespace palpate::experiment {
namespace {

PointCloud Cloud(const Eigen::Matrix3Xd& points) {
  PointCloud cloud;
  cloud.width = static_cast<int>(points.cols());
  cloud.points_m = points;
  return cloud;
}

Eigen::Matrix3Xd Points() {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  Eigen::Matrix3Xd points(3, 4);
  points << 0.1, 0.2, kNan, 0.0,  //
      -0.1, 0.3, kNan, 0.0,       //
      0.5, 0.6, kNan, 0.0;
  return points;
}

TEST(CloudConvention, MetresInTheOpticalFrameStayAsTheyAre) {
  const auto found = ConventionOf(Cloud(Points()));
  ASSERT_TRUE(found.has_value());
  EXPECT_FALSE(found->y_and_z_negated);
  EXPECT_EQ(found->unit_m, 1.0);
  EXPECT_EQ(ToText(*found), "");
}

TEST(CloudConvention, PointsBehindTheCameraAreTurnedAsTheRealSenseViewerHasThem) {
  Eigen::Matrix3Xd points = Points();
  points.bottomRows<2>() *= -1.0;
  PointCloud cloud = Cloud(points);
  const auto found = ConventionOf(cloud);
  ASSERT_TRUE(found && found->y_and_z_negated && found->unit_m == 1.0);
  EXPECT_THAT(ToText(*found), testing::HasSubstr("RealSense Viewer"));
  ToOpticalFrame(*found, &cloud);
  EXPECT_EQ(cloud.points_m.leftCols(2), Points().leftCols(2));
}

TEST(CloudConvention, TheUnitIsSeenByTheDistance) {
  for (const auto& [unit_m, name] : {std::pair{0.001, "millimetres"}, {0.01, "centimetres"}}) {
    PointCloud cloud = Cloud(Points() / unit_m);
    const auto found = ConventionOf(cloud);
    ASSERT_TRUE(found && !found->y_and_z_negated);
    EXPECT_EQ(found->unit_m, unit_m);
    EXPECT_THAT(ToText(*found), testing::HasSubstr(name));
    ToOpticalFrame(*found, &cloud);
    EXPECT_TRUE(cloud.points_m.leftCols(2).isApprox(Points().leftCols(2)));
  }
}

TEST(CloudConvention, AnEmptyCloudShowsNone) {
  EXPECT_FALSE(ConventionOf(Cloud(Points().rightCols(2))).has_value());
}

}  // namespace
}  // namespace palpate::experiment
