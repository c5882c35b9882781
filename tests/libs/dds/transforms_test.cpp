// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/transforms.hpp"

#include <gmock/gmock.h>

#include <cstdint>
#include <string>
#include <vector>

#include "libs/dds/stamp.hpp"
#include "tests/libs/dds/test_participant.hpp"

namespace palpate::dds {
namespace {

Eigen::Isometry3d Pose(double x_m, double angle_rad) {
  return Eigen::Translation3d(x_m, 0.1, -0.2) *
         Eigen::AngleAxisd(angle_rad, Eigen::Vector3d(1, 2, 3).normalized());
}

Message<idl::tf2_msgs::TFMessage> Link(const std::string& parent, const std::string& child,
                                       const Eigen::Isometry3d& T_parent_child) {
  Message<idl::tf2_msgs::TFMessage> message;
  Resize(message->transforms, 1);
  auto& transform = message->transforms._buffer[0];
  SetHeader(transform.header, 0, parent);
  SetText(transform.child_frame_id, child);
  const Eigen::Vector3d t = T_parent_child.translation();
  const Eigen::Quaterniond q(T_parent_child.linear());
  transform.transform.translation = {t.x(), t.y(), t.z()};
  transform.transform.rotation = {q.x(), q.y(), q.z(), q.w()};
  return message;
}

TEST(TransformTree, FindsTheChainBetweenTwoFramesBothWays) {
  const Eigen::Isometry3d T_link_depth = Pose(0.01, 0.1), T_link_color = Pose(0.03, -0.2);
  const Eigen::Isometry3d T_color_optical = Pose(0.0, 1.5);
  TransformTree tree;
  EXPECT_TRUE(tree.Add(*Link("camera_link", "depth", T_link_depth)).ok());
  EXPECT_TRUE(tree.Add(*Link("camera_link", "/color", T_link_color)).ok());
  EXPECT_TRUE(tree.Add(*Link("color", "color_optical", T_color_optical)).ok());
  const Eigen::Isometry3d expected = T_link_depth.inverse() * T_link_color * T_color_optical;
  ASSERT_TRUE(tree.Find("depth", "color_optical").has_value());
  EXPECT_TRUE(tree.Find("depth", "color_optical")->isApprox(expected, 1e-12));
  EXPECT_TRUE(tree.Find("color_optical", "depth")->isApprox(expected.inverse(), 1e-12));
  EXPECT_TRUE(tree.Find("depth", "depth")->isApprox(Eigen::Isometry3d::Identity()));
}

TEST(TransformTree, FramesThatNothingJoinsHaveNoTransform) {
  TransformTree tree;
  EXPECT_TRUE(tree.Add(*Link("a", "b", Pose(0, 0))).ok());
  EXPECT_TRUE(tree.Add(*Link("c", "d", Pose(0, 0))).ok());
  EXPECT_FALSE(tree.Find("b", "d").has_value());
}

TEST(TransformTree, ARingOfFramesEnds) {
  TransformTree tree;
  EXPECT_TRUE(tree.Add(*Link("a", "b", Pose(0, 0))).ok());
  EXPECT_TRUE(tree.Add(*Link("b", "a", Pose(0, 0))).ok());
  EXPECT_FALSE(tree.Find("a", "c").has_value());
  EXPECT_TRUE(tree.Find("a", "b").has_value());
}

TEST(TransformTree, WhatIsNoTransformIsRefusedAndTheRestTaken) {
  auto message = Link("a", "b", Pose(0, 0));
  message->transforms._buffer[0].transform.rotation = {0, 0, 0, 0};
  TransformTree tree;
  const Status status = tree.Add(*message);
  EXPECT_EQ(status.code(), StatusCode::kInvalidInput);
  EXPECT_THAT(status.message(), testing::HasSubstr("from 'a' to 'b'"));
  EXPECT_FALSE(tree.Find("a", "b").has_value());
}

TEST(TransformBroadcaster, ALateJoinerGetsAllTransformsOfASender) {
  TestNode sender("sender");
  TransformBroadcaster broadcaster(sender.participant);
  const Eigen::Isometry3d T_a_b = Pose(0.3, 0.4), T_b_c = Pose(0.1, -1.0);
  EXPECT_TRUE(broadcaster.Set("a", "b", Pose(9.0, 0.0), 1));
  EXPECT_TRUE(broadcaster.Set("b", "c", T_b_c, 2));
  EXPECT_TRUE(broadcaster.Set("a", "b", T_a_b, 3));
  TestNode late("late");
  auto reader = late.participant.CreateReader(kTfStaticTopic);
  TransformTree tree;
  late.loop.Attach(reader, [&] {
    for (const auto& message : reader.Take()) EXPECT_TRUE(tree.Add(message).ok());
  });
  ASSERT_TRUE(late.WaitFor([&] {
    const auto found = tree.Find("a", "c");
    return found && found->isApprox(T_a_b * T_b_c, 1e-12);
  }));
}

TEST(TransformBroadcaster, AnUnchangedTransformIsNotSentAgain) {
  TestNode sender("sender"), receiver("receiver");
  TransformBroadcaster broadcaster(sender.participant);
  auto reader = receiver.participant.CreateReader(kTfStaticTopic);
  EXPECT_TRUE(broadcaster.Set("a", "b", Pose(0.1, 0.2), 1));
  EXPECT_TRUE(broadcaster.Set("a", "b", Pose(0.1, 0.2), 2));
  EXPECT_TRUE(broadcaster.Set("a", "c", Pose(0.1, 0.2), 3));
  std::vector<std::uint32_t> sizes;
  receiver.loop.Attach(reader, [&] {
    for (const auto& message : reader.Take()) sizes.push_back(message.transforms._length);
  });
  ASSERT_TRUE(receiver.WaitFor([&] { return !sizes.empty() && sizes.back() == 2; }));
  EXPECT_LE(sizes.size(), 2u);
}

}  // namespace
}  // namespace palpate::dds
