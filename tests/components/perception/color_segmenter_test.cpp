// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

// The paper's way of segmentation on frames of the virtual bench, and the filters' laws.

#include "components/perception/color/color_segmenter.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "libs/core/error.hpp"
#include "libs/rgbd/depth_noise.hpp"
#include "tests/components/perception/labelled_scene.hpp"
#include "tests/support/test_folder.hpp"

namespace palpate::perception {
namespace {

using testing::HasSubstr;

/// Made once: what they show is only read.
struct Bench {
  Bench() {
    rest = PushedView(scenario, "02_push", 0.0);
    view = PushedView(scenario, "03_two_pushes", 4.0);
    predicted = Predict(scenario, rest.nodes_m);
    scene.Take(view);
  }
  scenario::Scenario scenario = PushScenario();
  virtual_camera::View rest;
  virtual_camera::View view;
  PredictedSurface predicted;
  LabelledScene scene{scenario};
};

Bench& TheBench() {
  static Bench bench;
  return bench;
}

ColorSegmenter MakeSegmenter(const Config& config = {}) {
  ColorSegmenter segmenter(config);
  segmenter.SetCamera(TheBench().scene.camera());
  return segmenter;
}

Config WithRobotColor() {
  Config config;
  const Eigen::Vector3d& rgb = TheBench().scenario.stage.robot_color_rgb;
  config.robot_color_rgb = {rgb.x(), rgb.y(), rgb.z()};
  return config;
}

/// Share of the points whose pixel shows `truth`.
double ShareOf(const rgbd::SensedCloud& cloud, Truth truth) {
  const LabelledScene& scene = TheBench().scene;
  int right = 0;
  for (Eigen::Index i = 0; i < cloud.Count(); ++i) {
    const Eigen::Vector2d pixel =
        rgbd::Project(scene.camera().depth, cloud.points_m.col(i).cast<double>());
    const int u = static_cast<int>(std::lround(pixel.x()));
    const int v = static_cast<int>(std::lround(pixel.y()));
    right += scene.TruthAt(u, v) == truth ? 1 : 0;
  }
  return static_cast<double>(right) / static_cast<double>(cloud.Count());
}

void ExpectSorted(const SegmentedFrame& frame) {
  ASSERT_TRUE(frame.status.ok()) << frame.status.message();
  EXPECT_GT(frame.robot.Count(), 3000);
  EXPECT_GT(frame.object.Count(), 200);
  EXPECT_GT(ShareOf(frame.robot, Truth::kRobot), 0.97);
  EXPECT_GT(ShareOf(frame.object, Truth::kTool), 0.9);
}

TEST(ColorSegmenter, LearnsTheColorFromThePredictedSurfaceAndKeepsIt) {
  ColorSegmenter segmenter = MakeSegmenter();
  const SegmentedFrame& frame = segmenter.Segment(TheBench().scene.frame(), nullptr);
  EXPECT_EQ(frame.status.code(), StatusCode::kNoRobotSeen);
  EXPECT_THAT(frame.status.message(), HasSubstr("neither set nor was it seen"));
  EXPECT_EQ(frame.robot.Count(), 0);
  ExpectSorted(segmenter.Segment(TheBench().scene.frame(), &TheBench().predicted));
  ASSERT_TRUE(segmenter.Segment(TheBench().scene.frame(), nullptr).status.ok());
}

TEST(ColorSegmenter, TakesTheColorFromTheSettings) {
  ColorSegmenter segmenter = MakeSegmenter(WithRobotColor());
  ExpectSorted(segmenter.Segment(TheBench().scene.frame(), nullptr));
  Config blue;
  blue.robot_color_rgb = {0.0, 0.1, 0.9};
  blue.color.robot_color_tolerance = 0.05;
  ColorSegmenter other = MakeSegmenter(blue);
  const SegmentedFrame& frame = other.Segment(TheBench().scene.frame(), nullptr);
  EXPECT_EQ(frame.status.code(), StatusCode::kNoRobotSeen);
  EXPECT_THAT(frame.status.message(), HasSubstr("nothing has the robot's colour"));
}

TEST(ColorSegmenter, TableAndWallAreNoObjects) {
  LabelledScene scene(TheBench().scenario);
  virtual_camera::View bare = TheBench().rest;
  bare.tools.clear();
  scene.Take(bare);
  ColorSegmenter segmenter = MakeSegmenter(WithRobotColor());
  for (const PredictedSurface* predicted :
       {static_cast<const PredictedSurface*>(nullptr),
        static_cast<const PredictedSurface*>(&TheBench().predicted)}) {
    const SegmentedFrame& frame = segmenter.Segment(scene.frame(), predicted);
    ASSERT_TRUE(frame.status.ok());
    EXPECT_GT(frame.robot.Count(), 3000);
    EXPECT_LT(frame.object.Count(), 30);
  }
}

TEST(ColorSegmenter, FramesThatCannotBeUsedAreSaid) {
  ColorSegmenter segmenter = MakeSegmenter(WithRobotColor());
  rgbd::RgbdFrame frame = TheBench().scene.frame();
  frame.depth = {};
  EXPECT_EQ(segmenter.Segment(frame, nullptr).status.code(), StatusCode::kInvalidInput);
  frame = TheBench().scene.frame();
  frame.color = rgbd::ColorImage(10, 10);
  EXPECT_EQ(segmenter.Segment(frame, nullptr).status.code(), StatusCode::kInvalidInput);
  frame = TheBench().scene.frame();
  std::fill(frame.depth.values.begin(), frame.depth.values.end(), std::uint16_t{0});
  const SegmentedFrame& blind = segmenter.Segment(frame, nullptr);
  EXPECT_EQ(blind.status.code(), StatusCode::kNoRobotSeen);
  EXPECT_EQ(blind.rejected.invalid_depth, static_cast<std::int64_t>(frame.depth.values.size()));
  ExpectSorted(segmenter.Segment(TheBench().scene.frame(), nullptr));
}

TEST(ColorSegmenter, AColorThatIsNoneIsRefused) {
  Config config;
  config.robot_color_rgb = {0.5, 0.5};
  EXPECT_THAT(test_support::MessageOf<InputError>([&] { ColorSegmenter segmenter(config); }),
              HasSubstr("robot_color_rgb has 2 numbers; must have three, or none"));
}

TEST(FilterFrame, EveryPixelIsInAPointOrRejectedForAReason) {
  Registration registration(TheBench().scene.camera());
  RegisteredFrame registered;
  ASSERT_TRUE(registration.Register(TheBench().scene.frame(), &registered).ok());
  for (std::size_t i = 0; i < 1000; ++i) registered.color_known[200'000 + i] = 0;
  Config config;
  config.color.background_extent_m = 100.0;  // no plane is so large
  for (const int most_points : {2000, 10000}) {
    config.max_cloud_points = most_points;
    Rejections rejected;
    const VoxelCloud cloud = FilterFrame(registered, registration,
                                         {{-0.2, -0.3, 0.2}, {0.3, 0.2, 0.7}}, config, &rejected);
    EXPECT_LE(cloud.Count(), most_points);
    EXPECT_GT(cloud.Count(), most_points / 3);
    EXPECT_GT(rejected.out_of_range, 0);
    EXPECT_GT(rejected.ambiguous, 850);
    EXPECT_EQ(rejected.invalid_depth + rejected.out_of_range + rejected.isolated +
                  rejected.ambiguous + rejected.thinned + cloud.Count(),
              848 * 480);
    EXPECT_GE(cloud.points_m.row(2).minCoeff(), 0.2f);
    EXPECT_LE(cloud.points_m.row(0).maxCoeff(), 0.3f);
  }
}

TEST(FilterFrame, LargerVoxelsHoldMorePixelsAndErrLess) {
  Config config = WithRobotColor();
  double last = 1.0;
  const double pixel_m = rgbd::DepthSigma_m(TheBench().scene.camera(), {}, 0.45);
  for (const double voxel_m : {0.004, 0.008, 0.016}) {
    config.color.voxel_m = voxel_m;
    ColorSegmenter segmenter = MakeSegmenter(config);
    const SegmentedFrame& frame = segmenter.Segment(TheBench().scene.frame(), nullptr);
    ASSERT_TRUE(frame.status.ok());
    const auto sigma_m = static_cast<double>(frame.robot.sigma_m.mean());
    EXPECT_LT(sigma_m, last);
    EXPECT_GT(sigma_m, 0.2 * pixel_m);
    EXPECT_LT(sigma_m, 1.1 * pixel_m);
    last = sigma_m;
  }
}

}  // namespace
}  // namespace palpate::perception
