// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/perception.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
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
    ASSERT_EQ(seen.contacts.size(), 1u) << "it was there when the camera was opened";
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
  for (int frame = 1; frame <= 3; ++frame) {
    EXPECT_EQ(perception.Update({}, nullptr).contacts.size(), frame < 3 ? 0u : 1u);
  }
  EXPECT_EQ(perception.Update({}, nullptr).contacts.at(0).name, "contact_2");
  // Opened again: earlier locations mean nothing.
  perception.SetCamera({});
  EXPECT_EQ(perception.Update({}, nullptr).contacts.at(0).name, "contact_3");
}

/// A green disc on a wall, whatever becomes of the robot.
TEST(Perception, MarkersAreLookedForWhereTheirColourIsTold) {
  SegmentedFrame next;
  next.status = Status(StatusCode::kNoRobotSeen, "turned away");
  rgbd::RgbdCamera camera;
  camera.depth = {.width_px = 80,
                  .height_px = 60,
                  .fx_px = 400.0,
                  .fy_px = 400.0,
                  .cx_px = 39.5,
                  .cy_px = 29.5};
  camera.depth_unit_m = 1e-3;
  camera.baseline_m = 0.05;
  camera.color = camera.depth;
  camera.color_registered = true;
  rgbd::RgbdFrame frame;
  frame.depth = rgbd::DepthImage(80, 60, 400);
  frame.color = rgbd::ColorImage(80, 60, 150);
  for (int v = 26; v <= 34; ++v) {
    for (int u = 36; u <= 44; ++u) {
      if (std::hypot(u - 40, v - 30) > 3.5) continue;
      std::uint8_t* rgb = frame.color.Pixel(u, v);
      rgb[0] = 26, rgb[1] = 178, rgb[2] = 51;
    }
  }
  Config config;
  Perception without(config, std::make_unique<GivenFrames>(&next));
  without.SetCamera(camera);
  EXPECT_EQ(without.Update(frame, nullptr).markers.status.code(), StatusCode::kNotRun);
  config.markers.color_rgb = {0.1, 0.7, 0.2};
  Perception with(config, std::make_unique<GivenFrames>(&next));
  with.SetCamera(camera);
  const FiducialFrame& seen = with.Update(frame, nullptr).markers;
  ASSERT_TRUE(seen.status.ok()) << seen.status.message();
  ASSERT_EQ(seen.fiducials.size(), 1u);
  EXPECT_NEAR(seen.fiducials[0].position_m.x(), 0.4 * 0.5 / 400.0, 1e-4);
  EXPECT_GT(seen.fiducials[0].covariance_m2.determinant(), 0.0);
  // What all of perception shares holds for them, too.
  config.min_z_m = 0.5;
  Perception near(config, std::make_unique<GivenFrames>(&next));
  near.SetCamera(camera);
  EXPECT_TRUE(near.Update(frame, nullptr).markers.fiducials.empty());
}

TEST(Perception, SettingsThatDoNotGoTogetherAreRefused) {
  SegmentedFrame next;
  Config config;
  config.min_z_m = config.max_z_m = 0.5;
  EXPECT_THAT(test_support::MessageOf<InputError>(
                  [&] { Perception perception(config, std::make_unique<GivenFrames>(&next)); }),
              HasSubstr("max_z_m is 0.5; must be larger than min_z_m, 0.5"));
  config = {};
  config.markers.names = {"tip"};
  EXPECT_THAT(test_support::MessageOf<InputError>(
                  [&] { Perception perception(config, std::make_unique<GivenFrames>(&next)); }),
              HasSubstr("markers.color_rgb is empty"));
}

}  // namespace
}  // namespace palpate::perception
