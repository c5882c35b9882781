// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/perception.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <utility>

#include "libs/core/error.hpp"
#include "tests/components/perception/contact_scene.hpp"
#include "tests/support/test_folder.hpp"

namespace palpate::perception {
namespace {

using test::SampleAll;
using testing::HasSubstr;

/// Gives what the test puts into `next`.
class GivenFrames : public Segmenter {
 public:
  explicit GivenFrames(SegmentedFrame* next) : next_(next) {}
  void SetCamera(const rgbd::RgbdCamera&) override {}
  const SegmentedFrame& Segment(const rgbd::RgbdFrame&, const PredictedSurface*) override {
    return *next_;
  }

 private:
  SegmentedFrame* next_;
};

SegmentedFrame Touched(std::vector<Eigen::Vector2d> touch_m) {
  SegmentedFrame frame;
  auto clouds = SampleAll({.plate_half_m = 0.05, .touch_m = std::move(touch_m)}, 0.002);
  frame.status = Status::Ok();
  frame.robot = std::move(clouds.robot);
  frame.object = std::move(clouds.object);
  return frame;
}

TEST(Perception, ContactsAreLocatedNamedAndGoneAgain) {
  SegmentedFrame next = Touched({{0.0, 0.0}});
  Perception perception(Config{}, std::make_unique<GivenFrames>(&next));
  perception.SetCamera({});
  for (int frame = 1; frame <= 3; ++frame) {
    const Observation& seen =
        perception.Update({.stamp_ns = 1000 + frame, .depth = {}, .color = {}}, nullptr);
    EXPECT_EQ(seen.stamp_ns, 1000 + frame);
    EXPECT_TRUE(seen.frame.status.ok());
    EXPECT_EQ(seen.frame.robot.Count(), next.robot.Count());
    ASSERT_EQ(seen.contacts.size(), frame < 3 ? 0u : 1u);
  }
  // A frame without the robot: hysteresis, then nothing.
  next = {};
  next.status = Status(StatusCode::kNoRobotSeen, "turned away");
  for (int frame = 1; frame <= 3; ++frame) {
    const Observation& seen = perception.Update({}, nullptr);
    EXPECT_EQ(seen.frame.status.code(), StatusCode::kNoRobotSeen);
    EXPECT_EQ(seen.frame.status.message(), "turned away");
    EXPECT_EQ(seen.contacts.size(), frame < 3 ? 1u : 0u);
  }
  next = Touched({{0.0, 0.0}});
  for (int frame = 1; frame <= 3; ++frame) perception.Update({}, nullptr);
  EXPECT_EQ(perception.Update({}, nullptr).contacts.at(0).name, "contact_2");
  // Another camera: places of before mean nothing.
  perception.SetCamera({});
  EXPECT_TRUE(perception.Update({}, nullptr).contacts.empty());
}

TEST(Perception, SettingsThatDoNotGoTogetherAreRefused) {
  SegmentedFrame next;
  Config config;
  config.min_z_m = config.max_z_m = 0.5;
  EXPECT_THAT(test_support::MessageOf<InputError>(
                  [&] { Perception perception(config, std::make_unique<GivenFrames>(&next)); }),
              HasSubstr("max_z_m is 0.5; must be larger than min_z_m, 0.5"));
}

}  // namespace
}  // namespace palpate::perception
