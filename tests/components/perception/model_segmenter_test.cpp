// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

// How well ModelSegmenter tells the robot from everything else, on frames of the virtual bench with
// the noise of a stereo camera. With PALPATE_PICTURES=folder each scene's labels are drawn there.

#include "components/perception/model/model_segmenter.hpp"

#include <gtest/gtest.h>

#include <iostream>

#include "tests/components/perception/labelled_scene.hpp"

namespace palpate::perception {
namespace {

constexpr double kOtherColor = 0.98;
constexpr double kSameColor = 0.95;
/// Of the tools' pixels that are nearer than object_distance_m.
constexpr double kTools = 0.9;

Score Classify(const std::string& name, const LabelledScene& scene, ModelSegmenter* segmenter,
               const PredictedSurface& predicted) {
  const SegmentedFrame& frame = segmenter->Segment(scene.frame(), &predicted);
  EXPECT_TRUE(frame.status.ok()) << frame.status.message();
  const Score score = Compare(scene, segmenter->region());
  DrawLabels(name, scene, segmenter->region());
  std::cout << name << ": robot recall " << score.robot_recall << ", precision "
            << score.robot_precision << " (" << score.robot_pixels << " px); tools recall "
            << score.tool_recall << " (" << score.tool_pixels << " px), precision "
            << score.object_precision << " (" << score.object_pixels << " px)\n";
  return score;
}

/// The first frame of a camera, nothing learnt before.
Score JudgeOnce(const std::string& name, const scenario::Scenario& scenario,
                const virtual_camera::View& view, const PredictedSurface& predicted) {
  LabelledScene scene(scenario);
  ModelSegmenter segmenter((Config()));
  segmenter.SetCamera(scene.camera());
  scene.Take(view);
  return Classify(name, scene, &segmenter, predicted);
}

void ExpectRobot(const Score& score, double least) {
  EXPECT_GE(score.robot_recall, least);
  EXPECT_GE(score.robot_precision, least);
}

scenario::Scenario WithToolsOfRobotColor(scenario::Scenario scenario) {
  for (auto& tool : scenario.tools) tool.color_rgb = scenario.stage.robot_color_rgb;
  return scenario;
}

TEST(ModelSegmenter, TellsTheRobotFromToolsOfAnotherColor) {
  const scenario::Scenario scenario = PushScenario();
  const virtual_camera::View rest = PushedView(scenario, "02_push", 0.0);
  for (const auto& [recording, t_s] :
       {std::pair("02_push", 2.0), std::pair("03_two_pushes", 4.0)}) {
    const virtual_camera::View view = PushedView(scenario, recording, t_s);
    const Score score = JudgeOnce(recording, scenario, view, Predict(scenario, rest.nodes_m));
    ExpectRobot(score, kOtherColor);
    EXPECT_GE(score.tool_recall, kTools);
    EXPECT_GE(score.object_precision, kTools);
  }
}

TEST(ModelSegmenter, TellsTheRobotFromToolsOfItsOwnColorInAnyLight) {
  scenario::Scenario scenario = WithToolsOfRobotColor(PushScenario());
  const virtual_camera::View rest = PushedView(scenario, "02_push", 0.0);
  const virtual_camera::View one = PushedView(scenario, "02_push", 2.0);
  const virtual_camera::View two = PushedView(scenario, "03_two_pushes", 4.0);
  const PredictedSurface predicted = Predict(scenario, rest.nodes_m);
  for (const double light : {0.5, 1.5}) {
    scenario.stage.light = light;
    const std::string name = light < 1.0 ? "same_color_dim" : "same_color_bright";
    for (const auto& [view, what] : {std::pair(&one, "_one"), std::pair(&two, "_two")}) {
      const Score score = JudgeOnce(name + what, scenario, *view, predicted);
      ExpectRobot(score, kSameColor);
      EXPECT_GE(score.tool_recall, kTools);
      EXPECT_GE(score.object_precision, kTools);
    }
  }
}

TEST(ModelSegmenter, GoesOnWhenTheLightChanges) {
  scenario::Scenario scenario = WithToolsOfRobotColor(PushScenario());
  const virtual_camera::View rest = PushedView(scenario, "02_push", 0.0);
  const virtual_camera::View view = PushedView(scenario, "03_two_pushes", 4.0);
  const PredictedSurface predicted = Predict(scenario, rest.nodes_m);
  ModelSegmenter segmenter((Config()));
  segmenter.SetCamera(scenario.camera->camera);
  for (const double light : {1.0, 0.5, 1.5}) {
    scenario.stage.light = light;
    LabelledScene scene(scenario);
    scene.Take(view);
    const std::size_t notes = segmenter.Segment(scene.frame(), &predicted).notes.size();
    EXPECT_EQ(notes, light == 1.0 ? 0u : 1u) << "in light " << light;
    DrawLabels("light_changes", scene, segmenter.region());
    ExpectRobot(Compare(scene, segmenter.region()), kSameColor);
    scene.Take(view);
    const SegmentedFrame& frame = segmenter.Segment(scene.frame(), &predicted);
    EXPECT_TRUE(frame.notes.empty()) << "the light is that of the frame before";
  }
}

TEST(ModelSegmenter, FollowsAPredictionThatIsOff) {
  const scenario::Scenario scenario = PushScenario();
  const virtual_camera::View rest = PushedView(scenario, "02_push", 0.0);
  const virtual_camera::View view = PushedView(scenario, "02_push", 2.0);
  const std::pair<Eigen::Vector3d, double> cases[] = {
      {{0.004, 0.0, 0.002}, kOtherColor},
      {{0.0, -0.006, 0.006}, kOtherColor},
      {{-0.004, 0.003, -0.008}, kOtherColor},
      {{0.010, 0.0, 0.0}, 0.97},
  };
  for (const auto& [off_m, least] : cases) {
    const Score score = JudgeOnce("off", scenario, view, Predict(scenario, rest.nodes_m, off_m));
    ExpectRobot(score, least);
    EXPECT_GE(score.tool_recall, kTools);
  }
}

}  // namespace
}  // namespace palpate::perception
