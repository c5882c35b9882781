// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/geometry_messages.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace palpate::dds {
namespace {

Eigen::Isometry3d SomePose() {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() =
      Eigen::AngleAxisd(2.5, Eigen::Vector3d(1.0, -2.0, 0.5).normalized()).toRotationMatrix();
  pose.translation() = Eigen::Vector3d(0.1, -0.2, 0.45);
  return pose;
}

TEST(PoseMessage, ThereAndBackIsTheSamePose) {
  Eigen::Isometry3d back = Eigen::Isometry3d::Identity();
  ASSERT_TRUE(FromPose(ToPose(SomePose()), &back));
  EXPECT_TRUE(back.isApprox(SomePose(), 1e-14));
}

TEST(PoseMessage, AQuaternionThatIsSlightlyOffIsNormalised) {
  auto message = ToPose(SomePose());
  message.orientation.w *= 1.0005;
  Eigen::Isometry3d back = Eigen::Isometry3d::Identity();
  ASSERT_TRUE(FromPose(message, &back));
  EXPECT_NEAR(back.linear().determinant(), 1.0, 1e-12);
}

TEST(PoseMessage, RefusesWhatIsNoPose) {
  Eigen::Isometry3d pose = SomePose();
  auto nan = ToPose(pose);
  nan.position.y = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(FromPose(nan, &pose));
  auto zero = ToPose(pose);
  zero.orientation = {0.0, 0.0, 0.0, 0.0};
  EXPECT_FALSE(FromPose(zero, &pose));
  auto nan_turn = ToPose(pose);
  nan_turn.orientation.x = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(FromPose(nan_turn, &pose));
  EXPECT_TRUE(pose.isApprox(SomePose()));
}

TEST(MeshMessage, HoldsNodesCellsAndTriangles) {
  const Eigen::Matrix3Xd nodes_m = Eigen::Matrix3Xd::Random(3, 4);
  const Eigen::MatrixXi cells = Eigen::Vector4i(0, 1, 2, 3);
  Eigen::Matrix3Xi triangles(3, 2);
  triangles << 0, 1, 1, 2, 2, 3;
  const auto message = ToMesh({"robot", "fnv1a-1", nodes_m, cells, triangles}, 5);
  EXPECT_EQ(Text(message->element), "tet4");
  EXPECT_EQ(Text(message->header.frame_id), "robot");
  ASSERT_EQ(message->nodes_m._length, 12u);
  EXPECT_EQ(message->nodes_m._buffer[4], nodes_m(1, 1));
  ASSERT_EQ(message->cells._length, 4u);
  ASSERT_EQ(message->surface_triangles._length, 6u);
  EXPECT_EQ(message->surface_triangles._buffer[5], 3u);
}

}  // namespace
}  // namespace palpate::dds
