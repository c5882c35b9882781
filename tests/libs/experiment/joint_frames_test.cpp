// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/experiment/images/joint_frames.hpp"

#include <gmock/gmock.h>

#include <set>

namespace palpate::experiment {
namespace {

constexpr std::int64_t kFramePeriod_ns = 33'333'333;

std::vector<std::int64_t> Times(int count, std::int64_t begin_ns,
                                std::int64_t period_ns = kFramePeriod_ns) {
  std::vector<std::int64_t> t_ns;
  for (int k = 0; k < count; ++k) t_ns.push_back(begin_ns + k * period_ns);
  return t_ns;
}

int Whole(const std::vector<JointFrame>& joint) {
  int whole = 0;
  for (const JointFrame& frame : joint) {
    bool all = true;
    for (const auto& number : frame.frames) all = all && number.has_value();
    whole += all ? 1 : 0;
  }
  return whole;
}

TEST(JointFrames, OfOneCameraAreItsFrames) {
  const auto joint = JoinFrames({Times(4, 7)});
  ASSERT_EQ(joint.size(), 4u);
  for (std::size_t k = 0; k < joint.size(); ++k) {
    EXPECT_EQ(joint[k].frames[0], k);
    EXPECT_EQ(joint[k].t_ns, 7 + static_cast<std::int64_t>(k) * kFramePeriod_ns);
  }
}

TEST(JointFrames, OfCamerasWithoutACommonTriggerAreNearestInTime) {
  for (const double late : {0.0, 0.2, 0.45, 0.55, 0.8}) {
    const auto late_ns = static_cast<std::int64_t>(late * kFramePeriod_ns);
    const auto joint = JoinFrames({Times(10, 0), Times(10, late_ns)});
    EXPECT_GE(Whole(joint), 9) << late;
    for (const JointFrame& frame : joint) {
      if (!frame.frames[0] || !frame.frames[1]) continue;
      const std::int64_t apart_ns = (static_cast<std::int64_t>(*frame.frames[1]) -
                                     static_cast<std::int64_t>(*frame.frames[0])) *
                                        kFramePeriod_ns +
                                    late_ns;
      EXPECT_LE(std::abs(apart_ns), kFramePeriod_ns / 2 + 1) << late;
      EXPECT_EQ(frame.t_ns, static_cast<std::int64_t>(*frame.frames[0]) * kFramePeriod_ns);
    }
  }
}

TEST(JointFrames, EachFrameIsUsedOnceInTheOrderOfTime) {
  const auto joint = JoinFrames(
      {Times(30, 0), Times(7, 5, 4 * kFramePeriod_ns), Times(20, 11, kFramePeriod_ns + 1000)});
  std::vector<std::set<std::size_t>> used(3);
  for (std::size_t k = 0; k < joint.size(); ++k) {
    if (k > 0) {
      EXPECT_GE(joint[k].t_ns, joint[k - 1].t_ns);
    }
    for (std::size_t camera = 0; camera < 3; ++camera) {
      if (joint[k].frames[camera]) {
        EXPECT_TRUE(used[camera].insert(*joint[k].frames[camera]).second);
      }
    }
  }
  EXPECT_EQ(used[0].size(), 30u);
  EXPECT_EQ(used[1].size(), 7u);
  EXPECT_EQ(used[2].size(), 20u);
}

TEST(JointFrames, AMissingCameraLeavesTheOthers) {
  const auto joint = JoinFrames({{}, Times(3, 0), {}});
  ASSERT_EQ(joint.size(), 3u);
  EXPECT_FALSE(joint[0].frames[0]);
  EXPECT_EQ(joint[2].frames[1], 2u);
  EXPECT_TRUE(JoinFrames({{}, {}}).empty());
}

}  // namespace
}  // namespace palpate::experiment
