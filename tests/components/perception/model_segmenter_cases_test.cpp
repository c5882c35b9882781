// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

// What ModelSegmenter does beside telling pixels: rest, crowds, missing predictions, colours and
// depths, repeatability, and the clouds that it hands on.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "components/perception/model/model_segmenter.hpp"
#include "libs/rgbd/depth_noise.hpp"
#include "libs/rgbd/rgbd_camera.hpp"
#include "tests/components/perception/labelled_scene.hpp"

namespace palpate::perception {
namespace {

using virtual_camera::View;

/// A ball of 1 cm that touches the hub, blue unless said otherwise.
View TouchedView(const scenario::Scenario& scenario) {
  View view = RestView(scenario);
  view.tools.push_back({"blue_ball", Eigen::Isometry3d::Identity()});
  view.tools.back().T_robot_tool.translation() = Eigen::Vector3d(0.0255, -0.0255, 0.103);
  return view;
}

/// The first frame of a camera before `view`, the body undeformed but predicted `off_m` away
/// (camera frame); labels drawn as `name`.
Score JudgeFirst(const std::string& name, const scenario::Scenario& scenario, const View& view,
                 const Eigen::Vector3d& off_m = Eigen::Vector3d::Zero()) {
  const PredictedSurface predicted = Predict(scenario, PushSkin().rest_m, off_m);
  LabelledScene scene(scenario);
  ReadySegmenter segmenter(scenario);
  scene.Take(view);
  const Status status = segmenter.Segment(scene.frame(), &predicted).status;
  EXPECT_TRUE(status.ok()) << status.message();
  DrawLabels(name, scene, segmenter.region());
  return Compare(scene, segmenter.region());
}

TEST(ModelSegmenter, SeesNoObjectWhereThereIsNone) {
  const scenario::Scenario scenario = PushScenario();
  const PredictedSurface predicted = Predict(scenario, PushSkin().rest_m);
  for (const std::uint64_t seed : {1, 2}) {
    LabelledScene scene(scenario, seed);
    ReadySegmenter segmenter(scenario);
    for (int i = 0; i < 3; ++i) {
      scene.Take(RestView(scenario));
      const SegmentedFrame& frame = segmenter.Segment(scene.frame(), &predicted);
      ASSERT_TRUE(frame.status.ok()) << frame.status.message();
      EXPECT_EQ(frame.object.Count(), 0) << "neither table nor wall nor markers are objects";
    }
  }
}

TEST(ModelSegmenter, TellsTheRobotFromATableOfItsColor) {
  scenario::Scenario scenario = PushScenario();
  scenario.stage.table_color_rgb = scenario.stage.robot_color_rgb;
  scenario.stage.background_color_rgb = scenario.stage.robot_color_rgb;
  const Score score = JudgeFirst("table_of_robot_color", scenario, RestView(scenario));
  EXPECT_GE(score.robot_recall, 0.98);
  EXPECT_GE(score.robot_precision, 0.98);
  EXPECT_EQ(score.object_pixels, 0);
}

TEST(ModelSegmenter, TakesLargeMarkersForRobot) {
  scenario::Scenario scenario = PushScenario();
  scenario.stage.marker_radius_m = 0.008;
  const Score score = JudgeFirst("large_markers", scenario, TouchedView(scenario));
  EXPECT_GE(score.robot_recall, 0.98);
  EXPECT_GE(score.object_precision, 0.98);
  EXPECT_GE(score.tool_recall, 0.9);
}

/// The undeformed body leaning over: nodes go by `aside_m` at the height of the tip, less below.
View LeaningView(const scenario::Scenario& scenario, const Eigen::Vector3d& aside_m) {
  constexpr double kTip_m = 0.125;
  View view = RestView(scenario);
  for (auto node_m : view.nodes_m.colwise()) {
    const double height = node_m.z() / kTip_m;
    node_m += height * height * aside_m;
  }
  return view;
}

/// A recording may begin with a robot that is bent already.
TEST(ModelSegmenter, FindsARobotThatIsBentFarFromItsPredictionWhereASequenceBegins) {
  const scenario::Scenario scenario = PushScenario();
  for (const Eigen::Vector3d& aside_m :
       {Eigen::Vector3d(0.025, 0.0, 0.0), Eigen::Vector3d(-0.02, 0.01, -0.01)}) {
    const Score score = JudgeFirst("leaning", scenario, LeaningView(scenario, aside_m));
    EXPECT_GE(score.robot_recall, 0.95) << aside_m.transpose();
    EXPECT_GE(score.robot_precision, 0.98) << aside_m.transpose();
    EXPECT_LE(score.object_pixels, score.robot_pixels / 50) << aside_m.transpose();
  }
}

/// What the last recording left bent is straight again in the next one.
TEST(ModelSegmenter, LooksForTheRobotWhereItWasFirstPredictedWhenTheCameraIsOpenedAnew) {
  const scenario::Scenario scenario = PushScenario();
  const View bent = LeaningView(scenario, {0.03, 0.02, 0.0});
  LabelledScene scene(scenario);
  ReadySegmenter segmenter(scenario);
  const PredictedSurface straight = Predict(scenario, PushSkin().rest_m);
  scene.Take(RestView(scenario));
  ASSERT_TRUE(segmenter.Segment(scene.frame(), &straight).status.ok());
  segmenter.SetCamera(scenario.camera->camera);
  const PredictedSurface predicted = Predict(scenario, bent.nodes_m);
  scene.Take(RestView(scenario));
  ASSERT_TRUE(segmenter.Segment(scene.frame(), &predicted).status.ok());
  const Score score = Compare(scene, segmenter.region());
  EXPECT_GE(score.robot_recall, 0.98);
  EXPECT_EQ(score.object_pixels, 0);
}

/// A plate, `thick_m`, flat on the back of the east leg.
View PlatedView(double thick_m, const Eigen::Vector3d& color_rgb, scenario::Scenario* scenario) {
  scenario::Tool& plate = scenario->tools.emplace_back(scenario->tools.front());
  plate.name = "plate";
  plate.shape = scenario::ToolShape::kPlate;
  plate.size_m = {0.03, 0.03, thick_m};
  plate.color_rgb = color_rgb;
  const Eigen::Vector3d outwards = Eigen::Vector3d(0.020, 0.0, 0.0287).normalized();
  View view = RestView(*scenario);
  view.tools.push_back({"plate", Eigen::Isometry3d::Identity()});
  view.tools[0].T_robot_tool.linear() =
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), outwards).toRotationMatrix();
  view.tools[0].T_robot_tool.translation() =
      Eigen::Vector3d(0.0598, 0.0, 0.0858) + 0.5 * thick_m * outwards;
  return view;
}

/// A flat thing of another colour on the robot: learnt colours tell what the shape cannot.
TEST(ModelSegmenter, TellsAPlateOnTheSurfaceByColorsLearntBefore) {
  scenario::Scenario scenario = PushScenario();
  const View view = PlatedView(0.004, scenario.tools.front().color_rgb, &scenario);
  const PredictedSurface predicted = Predict(scenario, PushSkin().rest_m);
  LabelledScene scene(scenario);
  ReadySegmenter segmenter(scenario);
  for (int i = 0; i < 16; ++i) {
    scene.Take(i == 0 ? RestView(scenario) : i < 4 ? TouchedView(scenario) : view);
    ASSERT_TRUE(segmenter.Segment(scene.frame(), &predicted).status.ok());
  }
  const Score score = Compare(scene, segmenter.region());
  DrawLabels("plate", scene, segmenter.region());
  EXPECT_GE(score.robot_recall, 0.98);
  EXPECT_GE(score.robot_precision, 0.98);
  EXPECT_GE(score.tool_recall, 0.8) << "not learnt as the robot's colour while it stays";
}

TEST(ModelSegmenter, KeepsItsColorsWhenTheSameCameraIsOpenedAnew) {
  scenario::Scenario scenario = PushScenario();
  const View view = PlatedView(0.004, scenario.tools.front().color_rgb, &scenario);
  const PredictedSurface predicted = Predict(scenario, PushSkin().rest_m);
  rgbd::RgbdCamera another = scenario.camera->camera;
  another.depth.cx_px += 0.5;
  for (const bool same : {true, false}) {
    LabelledScene scene(scenario);
    ReadySegmenter segmenter(scenario);
    scene.Take(RestView(scenario));
    ASSERT_TRUE(segmenter.Segment(scene.frame(), &predicted).status.ok());
    segmenter.SetCamera(same ? scenario.camera->camera : another);
    scene.Take(view);  // by its colours alone: no surface is predicted
    EXPECT_EQ(segmenter.Segment(scene.frame(), nullptr).status.ok(), same);
  }
}

/// Its colour is that of few pixels and does not draw the predicted surface towards it; one of the
/// robot's own colour has to be thicker.
TEST(ModelSegmenter, TellsAPlateOnTheSurfaceInTheFirstFrame) {
  const Eigen::Vector3d blue(0.15, 0.30, 0.80);
  for (const auto& [thick_m, color_rgb] :
       {std::pair(0.004, blue), std::pair(0.008, scenario::Stage().robot_color_rgb)}) {
    for (const double off : {0.0, 1.0}) {
      scenario::Scenario scenario = PushScenario();
      const View view = PlatedView(thick_m, color_rgb, &scenario);
      const Score score =
          JudgeFirst("first_plate", scenario, view, off * Eigen::Vector3d(0.003, -0.002, 0.004));
      EXPECT_GE(score.robot_recall, 0.98);
      EXPECT_GE(score.robot_precision, 0.98);
      EXPECT_GE(score.tool_recall, 0.85);
      EXPECT_GE(score.object_precision, 0.98);
    }
  }
}

TEST(ModelSegmenter, CopesWithTwentyObjects) {
  scenario::Scenario scenario = PushScenario();
  View view = RestView(scenario);
  scenario.tools.clear();
  std::mt19937 generator(5);
  std::uniform_real_distribution<double> draw(-1.0, 1.0);
  while (scenario.tools.size() < 20) {
    const Eigen::Vector3d at_m(0.12 * draw(generator), 0.12 * draw(generator),
                               0.09 + 0.06 * draw(generator));
    const double free_m = (view.nodes_m.colwise() - at_m).colwise().norm().minCoeff();
    const double least_m = 0.026;  // half a cylinder's length
    if (free_m < least_m) continue;
    scenario::Tool& tool = scenario.tools.emplace_back();
    tool.name = "object_" + std::to_string(scenario.tools.size());
    tool.shape = scenario.tools.size() % 2 == 0 ? scenario::ToolShape::kSphere
                                                : scenario::ToolShape::kCylinder;
    tool.color_rgb = scenario.tools.size() % 3 == 0 ? scenario.stage.robot_color_rgb
                                                    : Eigen::Vector3d(0.2, 0.6, 0.3);
    view.tools.push_back({tool.name, Eigen::Isometry3d::Identity()});
    view.tools.back().T_robot_tool.translation() = at_m;
  }
  const PredictedSurface predicted = Predict(scenario, PushSkin().rest_m);
  LabelledScene scene(scenario);
  ReadySegmenter segmenter(scenario);
  scene.Take(view);
  const SegmentedFrame& frame = segmenter.Segment(scene.frame(), &predicted);
  DrawLabels("twenty_objects", scene, segmenter.region());
  ASSERT_TRUE(frame.status.ok()) << frame.status.message();
  const Score score = Compare(scene, segmenter.region());
  EXPECT_GE(score.robot_recall, 0.95);
  EXPECT_GE(score.robot_precision, 0.95);
  EXPECT_GE(score.object_precision, 0.95);
  EXPECT_GT(frame.object.Count(), 500);
}

TEST(ModelSegmenter, LeavesOutObjectsAwayFromTheRobot) {
  const scenario::Scenario scenario = PushScenario();
  const PredictedSurface predicted = Predict(scenario, PushSkin().rest_m);
  const Eigen::Vector3d hub_m(0.0, 0.0, 0.103);
  const Eigen::Vector3d to_camera =
      (scenario.camera->T_robot_camera.translation() - hub_m).normalized();
  for (const auto& [distance_m, near] : {std::pair(0.05, true), std::pair(0.11, false)}) {
    View view = RestView(scenario);
    view.tools.push_back({"blue_ball", Eigen::Isometry3d::Identity()});
    view.tools[0].T_robot_tool.translation() = hub_m + distance_m * to_camera;
    LabelledScene scene(scenario);
    ReadySegmenter segmenter(scenario);
    scene.Take(view);
    const SegmentedFrame& frame = segmenter.Segment(scene.frame(), &predicted);
    ASSERT_TRUE(frame.status.ok());
    EXPECT_EQ(frame.object.Count() > 0, near) << distance_m;
  }
}

TEST(ModelSegmenter, WorksWithHalfTheRobotInView) {
  scenario::Scenario scenario = PushScenario();
  scenario.camera->camera.depth.cx_px = scenario.camera->camera.color.cx_px = 20.0;
  const Score score = JudgeFirst("half_in_view", scenario, RestView(scenario));
  EXPECT_GE(score.robot_recall, 0.98);
  EXPECT_GE(score.robot_precision, 0.98);
}

TEST(ModelSegmenter, WorksWithAColorCameraOfItsOwn) {
  scenario::Scenario scenario = PushScenario();
  rgbd::RgbdCamera& camera = scenario.camera->camera;
  camera.color_registered = false;
  camera.color.fx_px = camera.color.fy_px = 400.0;
  camera.T_depth_color.translation() = Eigen::Vector3d(0.015, 0.0, 0.0);
  const Score score = JudgeFirst("color_camera", scenario, TouchedView(scenario));
  EXPECT_GE(score.robot_recall, 0.98);
  EXPECT_GE(score.robot_precision, 0.98);
  EXPECT_GE(score.tool_recall, 0.9);
}

TEST(ModelSegmenter, GoesOnByLearntColorsWithoutAPrediction) {
  const scenario::Scenario scenario = PushScenario();
  const PredictedSurface predicted = Predict(scenario, PushSkin().rest_m);
  LabelledScene scene(scenario);
  ReadySegmenter segmenter(scenario);
  scene.Take(TouchedView(scenario));
  const SegmentedFrame& frame = segmenter.Segment(scene.frame(), nullptr);
  EXPECT_EQ(frame.status.code(), StatusCode::kNoRobotSeen) << "nothing is known yet";
  EXPECT_EQ(frame.robot.Count(), 0);
  ASSERT_TRUE(segmenter.Segment(scene.frame(), &predicted).status.ok());
  scene.Take(TouchedView(scenario));
  ASSERT_TRUE(segmenter.Segment(scene.frame(), nullptr).status.ok());
  const Score score = Compare(scene, segmenter.region());
  DrawLabels("without_prediction", scene, segmenter.region());
  EXPECT_GE(score.robot_recall, 0.9);
  EXPECT_GE(score.robot_precision, 0.95);
  EXPECT_GE(score.tool_recall, 0.9);
}

TEST(ModelSegmenter, StartsByTheColorOfTheSettings) {
  const scenario::Scenario scenario = PushScenario();
  Config config;
  config.robot_color_rgb = {0.85, 0.30, 0.25};
  ReadySegmenter segmenter(scenario, config);
  LabelledScene scene(scenario);
  scene.Take(RestView(scenario));
  const SegmentedFrame& frame = segmenter.Segment(scene.frame(), nullptr);
  ASSERT_TRUE(frame.status.ok()) << frame.status.message();
  EXPECT_FALSE(frame.notes.empty());
  const Score score = Compare(scene, segmenter.region());
  DrawLabels("color_of_settings", scene, segmenter.region());
  EXPECT_GE(score.robot_recall, 0.9);
  EXPECT_GE(score.robot_precision, 0.95);
}

TEST(ModelSegmenter, SaysThatColorsAreSaturatedAndGoesByShape) {
  const scenario::Scenario scenario = PushScenario();
  const PredictedSurface predicted = Predict(scenario, PushSkin().rest_m);
  LabelledScene scene(scenario);
  ReadySegmenter segmenter(scenario);
  scene.Take(TouchedView(scenario));
  rgbd::RgbdFrame white = scene.frame();
  std::fill(white.color.values.begin(), white.color.values.end(), std::uint8_t{255});
  const SegmentedFrame& frame = segmenter.Segment(white, &predicted);
  ASSERT_TRUE(frame.status.ok()) << frame.status.message();
  ASSERT_EQ(frame.notes.size(), 1u);
  EXPECT_NE(frame.notes[0].find("saturated"), std::string::npos) << frame.notes[0];
  const Score score = Compare(scene, segmenter.region());
  EXPECT_GE(score.robot_recall, 0.95);
  EXPECT_GE(score.robot_precision, 0.95);
}

TEST(ModelSegmenter, GivesTheSameBitsForTheSameFrames) {
  const scenario::Scenario scenario = PushScenario();
  const PredictedSurface predicted = Predict(scenario, PushSkin().rest_m);
  LabelledScene scene(scenario);
  ReadySegmenter one(scenario), other(scenario);
  for (int i = 0; i < 3; ++i) {
    scene.Take(TouchedView(scenario));
    const SegmentedFrame& a = one.Segment(scene.frame(), &predicted);
    const SegmentedFrame& b = other.Segment(scene.frame(), &predicted);
    ASSERT_GT(a.object.Count(), 0);
    EXPECT_EQ(a.robot.points_m, b.robot.points_m);
    EXPECT_EQ(a.robot.sigma_m, b.robot.sigma_m);
    EXPECT_EQ(a.robot.colors_rgb, b.robot.colors_rgb);
    EXPECT_EQ(a.object.points_m, b.object.points_m);
  }
}

TEST(ModelSegmenter, AveragesInsteadOfThrowingAway) {
  scenario::Scenario scenario = PushScenario();
  scenario.camera->noise.low_frequency_bias = 0.0;
  scenario.camera->noise.periodic_bias_px = 0.0;
  const PredictedSurface predicted = Predict(scenario, PushSkin().rest_m);
  LabelledScene scene(scenario);
  scene.Take(RestView(scenario));
  Config config;
  Eigen::Index fewer = std::numeric_limits<Eigen::Index>::max();
  float sigma_m = 1.0f;
  for (const int most : {10000, 2000, 500}) {
    config.max_cloud_points = most;
    ReadySegmenter segmenter(scenario, config);
    const SegmentedFrame& frame = segmenter.Segment(scene.frame(), &predicted);
    ASSERT_TRUE(frame.status.ok());
    EXPECT_LE(frame.robot.Count(), most);
    EXPECT_GE(frame.robot.Count(), most / 3) << "the cloud is as fine as it may be";
    EXPECT_LT(frame.robot.Count(), fewer);
    fewer = frame.robot.Count();
    EXPECT_EQ(static_cast<std::size_t>(fewer) * 3, frame.robot.colors_rgb.size());
    EXPECT_LE(frame.robot.sigma_m.mean(), 1.02f * sigma_m);
    sigma_m = frame.robot.sigma_m.mean();
    const auto robot_px =
        std::count(segmenter.region().label.begin(), segmenter.region().label.end(), Label::kRobot);
    EXPECT_EQ(frame.rejected.thinned, robot_px - fewer);
  }
  const double mean_z_m = predicted.vertices_m.row(2).mean();
  const double pixels = 11000.0 / static_cast<double>(fewer);
  const double expected_m = rgbd::DepthSigma_m(scene.camera(), {}, mean_z_m) /
                            std::sqrt(rgbd::IndependentPixels({}, pixels));
  EXPECT_NEAR(static_cast<double>(sigma_m), expected_m, 0.2 * expected_m);
}

TEST(ModelSegmenter, RejectsPixelsBetweenSurfaces) {
  scenario::Scenario scenario = PushScenario();
  scenario.camera->noise.flying_pixel_ratio = 0.3;
  const PredictedSurface predicted = Predict(scenario, PushSkin().rest_m);
  LabelledScene scene(scenario);
  ReadySegmenter segmenter(scenario);
  scene.Take(TouchedView(scenario));
  const SegmentedFrame& frame = segmenter.Segment(scene.frame(), &predicted);
  ASSERT_TRUE(frame.status.ok());
  const Score score = Compare(scene, segmenter.region());
  DrawLabels("flying_pixels", scene, segmenter.region());
  EXPECT_GT(score.mixed_pixels, 100);
  EXPECT_LT(score.mixed_kept, 0.1 * score.mixed_pixels);
  EXPECT_GT(frame.rejected.at_depth_edge, 0.5 * score.mixed_pixels);
}

}  // namespace
}  // namespace palpate::perception
