// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/cloud_messages.hpp"

#include <gmock/gmock.h>

#include <cstring>
#include <limits>

#include "libs/dds/stamp.hpp"

namespace palpate::dds {
namespace {

using idl::sensor_msgs::PointCloud2;
using ::testing::HasSubstr;

rgbd::SensedCloud TwoPoints() {
  rgbd::SensedCloud cloud;
  cloud.points_m.resize(3, 2);
  cloud.points_m << 0.1f, -0.2f, 0.3f, 0.4f, 0.5f, 0.6f;
  cloud.sigma_m = Eigen::Vector2f(1e-3f, 2e-3f);
  cloud.colors_rgb = {1, 2, 3, 250, 251, 252};
  return cloud;
}

template <typename Change>
std::string RefusalAfter(const Change& change) {
  auto message = ToPointCloud2(TwoPoints(), 7, "camera");
  change(*message);
  rgbd::SensedCloud cloud;
  return FromPointCloud2(*message, &cloud).message();
}

TEST(CloudMessage, ThereAndBackIsTheSameCloudBitByBit) {
  const rgbd::SensedCloud cloud = TwoPoints();
  const auto message = ToPointCloud2(cloud, 1'500'000'000, "camera");
  rgbd::SensedCloud back;
  const Status status = FromPointCloud2(*message, &back);
  ASSERT_TRUE(status.ok()) << status.message();
  EXPECT_EQ(back.points_m, cloud.points_m);
  EXPECT_EQ(back.sigma_m, cloud.sigma_m);
  EXPECT_EQ(back.colors_rgb, cloud.colors_rgb);
  EXPECT_EQ(StampNs(message->header.stamp), 1'500'000'000);
  EXPECT_EQ(Text(message->header.frame_id), "camera");
}

TEST(CloudMessage, IsLaidOutAsViewersOfRosExpect) {
  const auto message = ToPointCloud2(TwoPoints(), 0, "camera");
  EXPECT_EQ(message->width, 2u);
  EXPECT_EQ(message->height, 1u);
  EXPECT_EQ(message->row_step, 40u);
  EXPECT_TRUE(message->is_dense);
  ASSERT_EQ(message->fields._length, 5u);
  EXPECT_EQ(Text(message->fields._buffer[3].name), "rgb");
  EXPECT_EQ(message->fields._buffer[3].offset, 12u);
  EXPECT_EQ(message->fields._buffer[3].datatype, 7);
  // In memory: blue, green, red, nothing.
  const std::uint8_t wanted[] = {3, 2, 1, 0};
  EXPECT_EQ(std::memcmp(message->data._buffer + 12, wanted, 4), 0);
}

TEST(CloudMessage, TheLargestCloudIsNoMoreThanARemoteLinkCarries) {
  rgbd::SensedCloud cloud;
  cloud.points_m = Eigen::Matrix3Xf::Ones(3, 10000);
  cloud.sigma_m = Eigen::VectorXf::Ones(10000);
  cloud.colors_rgb.assign(30000, 0);
  EXPECT_LE(ToPointCloud2(cloud, 0, "camera")->data._length, 200'000u);
}

TEST(CloudMessage, AnEmptyCloudIsACloud) {
  rgbd::SensedCloud back = TwoPoints();
  ASSERT_TRUE(FromPointCloud2(*ToPointCloud2({}, 0, "camera"), &back).ok());
  EXPECT_EQ(back.Count(), 0);
}

TEST(CloudMessage, OfSeveralCamerasHasTheCameraOfEachPoint) {
  const JoinedCloud cloud{TwoPoints(), {0, 2}};
  const auto message = ToJoinedPointCloud2(cloud, 7, "camera");
  EXPECT_EQ(message->point_step, 24u);
  ASSERT_EQ(message->fields._length, 6u);
  EXPECT_EQ(Text(message->fields._buffer[5].name), "camera");
  EXPECT_EQ(message->fields._buffer[5].datatype, 6);
  JoinedCloud back;
  ASSERT_TRUE(FromJoinedPointCloud2(*message, &back).ok());
  EXPECT_EQ(back.points.points_m, cloud.points.points_m);
  EXPECT_EQ(back.points.sigma_m, cloud.points.sigma_m);
  EXPECT_EQ(back.points.colors_rgb, cloud.points.colors_rgb);
  EXPECT_EQ(back.cameras, cloud.cameras);
  // Who knows one camera takes its points.
  rgbd::SensedCloud first;
  ASSERT_TRUE(FromPointCloud2(*message, &first).ok());
  ASSERT_EQ(first.Count(), 1);
  EXPECT_EQ(first.points_m.col(0), cloud.points.points_m.col(0));
}

TEST(CloudMessage, IsSplitIntoTheCloudsOfItsCameras) {
  const Eigen::Isometry3d T_back_first(Eigen::Translation3d(1.0, 2.0, 3.0));
  std::vector<rgbd::SensedCloud> clouds;
  ASSERT_TRUE(SplitCloud({TwoPoints(), {1, 0}}, {T_back_first}, &clouds).ok());
  ASSERT_EQ(clouds.size(), 2u);
  ASSERT_EQ(clouds[0].Count(), 1);
  EXPECT_EQ(clouds[0].points_m.col(0), TwoPoints().points_m.col(1));
  EXPECT_EQ(clouds[0].sigma_m[0], TwoPoints().sigma_m[1]);
  ASSERT_EQ(clouds[1].Count(), 1);
  EXPECT_TRUE(clouds[1].points_m.col(0).isApprox(TwoPoints().points_m.col(0) +
                                                 Eigen::Vector3f(1.0f, 2.0f, 3.0f)));
  EXPECT_EQ(clouds[1].sigma_m[0], TwoPoints().sigma_m[0]);
  EXPECT_EQ(clouds[1].colors_rgb.size(), 3u);
  EXPECT_THAT(SplitCloud({TwoPoints(), {0, 2}}, {T_back_first}, &clouds).message(),
              HasSubstr("a point of camera 2: the settings have 2 cameras"));
}

TEST(CloudMessage, WithoutCamerasIsOfTheFirst) {
  JoinedCloud back;
  ASSERT_TRUE(FromJoinedPointCloud2(*ToPointCloud2(TwoPoints(), 7, "camera"), &back).ok());
  EXPECT_EQ(back.cameras, (std::vector<std::uint32_t>{0, 0}));
  auto message = ToJoinedPointCloud2({TwoPoints(), {0, 1}}, 7, "camera");
  message->fields._buffer[5].datatype = 7;
  EXPECT_THAT(FromJoinedPointCloud2(*message, &back).message(), HasSubstr("layout"));
}

TEST(CloudMessage, RefusesWhatIsNoCloudOfOurs) {
  EXPECT_EQ(RefusalAfter([](PointCloud2&) {}), "");
  EXPECT_THAT(RefusalAfter([](PointCloud2& m) { m.is_bigendian = true; }), HasSubstr("layout"));
  EXPECT_THAT(RefusalAfter([](PointCloud2& m) { SetText(m.fields._buffer[4].name, "s"); }),
              HasSubstr("layout"));
  EXPECT_THAT(RefusalAfter([](PointCloud2& m) { m.fields._buffer[0].datatype = 8; }),
              HasSubstr("layout"));
  EXPECT_THAT(RefusalAfter([](PointCloud2& m) { m.width = 3; }), HasSubstr("3 x 1 points"));
  EXPECT_THAT(RefusalAfter([](PointCloud2& m) { m.data._length = 39; }), HasSubstr("39 bytes"));
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(RefusalAfter([&](PointCloud2& m) { std::memcpy(m.data._buffer + 24, &nan, 4); }),
              HasSubstr("point 1"));
  const float zero = 0.0f;
  EXPECT_THAT(RefusalAfter([&](PointCloud2& m) { std::memcpy(m.data._buffer + 16, &zero, 4); }),
              HasSubstr("point 0"));
}

}  // namespace
}  // namespace palpate::dds
