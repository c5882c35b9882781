// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

// The same pushes before other cameras and in other surroundings, nothing tuned to any of them:
// pixels classified, contacts found where the balls touch.

#include <gtest/gtest.h>

#include <functional>
#include <iostream>
#include <memory>

#include "components/perception/perception.hpp"
#include "tests/components/perception/labelled_scene.hpp"
#include "tests/components/perception/touch_of.hpp"

namespace palpate::perception {
namespace {

using scenario::Scenario;

struct Variant {
  std::string name;
  std::function<void(Scenario*)> change;
};

void PrintTo(const Variant& variant, std::ostream* out) { *out << variant.name; }

void SetImage(int width_px, int height_px, double focal_px, rgbd::CameraModel* camera) {
  *camera = {.width_px = width_px,
             .height_px = height_px,
             .fx_px = focal_px,
             .fy_px = focal_px,
             .cx_px = 0.5 * (width_px - 1),
             .cy_px = 0.5 * (height_px - 1)};
}

void WithoutNoise(Scenario* scenario) {
  scenario->camera->noise.sensor = scenario::DepthSensor::kNone;
}

void InMillimetres(Scenario* scenario) {
  WithoutNoise(scenario);
  scenario->camera->camera.depth_unit_m = 1e-3;
}

void WithoutSurroundings(Scenario* scenario) {
  scenario->stage.table_height_m = -10.0;
  scenario->stage.background_distance_m = 0.0;
}

void OneImage(int width_px, int height_px, double focal_px, Scenario* scenario) {
  rgbd::RgbdCamera& camera = scenario->camera->camera;
  SetImage(width_px, height_px, focal_px, &camera.depth);
  camera.color = camera.depth;
}

void ColorBeside(Scenario* scenario) {
  rgbd::RgbdCamera& camera = scenario->camera->camera;
  SetImage(1280, 720, 900.0, &camera.color);
  camera.color_registered = false;
  camera.T_depth_color.translation() = Eigen::Vector3d(0.025, 0.0, 0.0);
}

void TimeOfFlight(Scenario* scenario) {
  scenario->camera->camera.baseline_m = 0.0;
  scenario->camera->noise.sensor = scenario::DepthSensor::kTimeOfFlight;
}

/// What the robot stands on, and nothing else.
void OnBase(const Eigen::Vector2d& size_m, Scenario* scenario) {
  scenario->stage.table_size_m = size_m;
  scenario->stage.background_distance_m = 0.0;
}

void ToolsOfRobotColor(Scenario* scenario) {
  for (auto& tool : scenario->tools) tool.color_rgb = scenario->stage.robot_color_rgb;
}

void Dim(Scenario* scenario) {
  ToolsOfRobotColor(scenario);
  scenario->stage.light = 0.2;
}

void AllOneColor(const Eigen::Vector3d& rgb, Scenario* scenario) {
  scenario::Stage& stage = scenario->stage;
  stage.robot_color_rgb = stage.table_color_rgb = stage.background_color_rgb = rgb;
  ToolsOfRobotColor(scenario);
}

void AllAtOnce(Scenario* scenario) {
  OneImage(640, 480, 500.0, scenario);
  InMillimetres(scenario);
  scenario->camera->camera.baseline_m = 0.0;
  ColorBeside(scenario);
  WithoutSurroundings(scenario);
  ToolsOfRobotColor(scenario);
}

class OtherCameras : public testing::TestWithParam<Variant> {};

TEST_P(OtherCameras, PixelsAreToldAndContactsFound) {
  static const Scenario pushes = PushScenario();
  static const virtual_camera::View rest = PushedView(pushes, "02_push", 0.0);
  static const virtual_camera::View views[] = {PushedView(pushes, "02_push", 2.0),
                                               PushedView(pushes, "03_two_pushes", 4.0)};
  Scenario scenario = pushes;
  GetParam().change(&scenario);
  const PredictedSurface predicted = Predict(scenario, rest.nodes_m);
  for (const virtual_camera::View& view : views) {
    auto segmenter = std::make_unique<ModelSegmenter>(Config());
    const ModelSegmenter& by_model = *segmenter;
    Perception perception({}, std::move(segmenter));
    perception.SetCamera(scenario.camera->camera);
    LabelledScene scene(scenario);
    for (int frame = 1; frame < TrackingConfig().appear_frames; ++frame) {
      scene.Take(view);
      perception.Update(scene.frame(), &predicted);
    }
    scene.Take(view);
    const Observation& seen = perception.Update(scene.frame(), &predicted);
    ASSERT_TRUE(seen.frame.status.ok()) << seen.frame.status.message();
    const Score score = Compare(scene, by_model.region());
    DrawLabels(GetParam().name, scene, by_model.region());
    std::cout << GetParam().name << ": robot recall " << score.robot_recall << ", precision "
              << score.robot_precision << " (" << score.robot_pixels << " px); tools recall "
              << score.tool_recall << " (" << score.tool_pixels << " px), precision "
              << score.object_precision << " (" << score.object_pixels << " px)\n";
    EXPECT_GE(score.robot_recall, 0.97);
    EXPECT_GE(score.robot_precision, 0.98);
    EXPECT_GE(score.tool_recall, 0.9);
    EXPECT_GE(score.object_precision, 0.9);
    ExpectContacts(seen, scenario, view, 0.005);
  }
}

INSTANTIATE_TEST_SUITE_P(
    , OtherCameras,
    testing::Values(Variant{"without_noise", WithoutNoise}, Variant{"millimetres", InMillimetres},
                    Variant{"vga", [](Scenario* s) { OneImage(640, 480, 500.0, s); }},
                    Variant{"qvga", [](Scenario* s) { OneImage(320, 240, 250.0, s); }},
                    Variant{"color_beside", ColorBeside},
                    Variant{"without_color", [](Scenario* s) { s->camera->camera.color = {}; }},
                    Variant{"time_of_flight", TimeOfFlight},
                    Variant{"without_surroundings", WithoutSurroundings},
                    Variant{"small_table",
                            [](Scenario* s) {
                              OnBase({0.25, 0.25}, s);
                            }},
                    Variant{"base",
                            [](Scenario* s) {
                              OnBase({0.15, 0.15}, s);
                            }},
                    Variant{"board",
                            [](Scenario* s) {
                              OnBase({0.30, 0.10}, s);
                            }},
                    Variant{"dim", Dim},
                    Variant{"dark",
                            [](Scenario* s) {
                              AllOneColor({0.06, 0.05, 0.05}, s);
                            }},
                    Variant{"grey",
                            [](Scenario* s) {
                              AllOneColor({0.5, 0.5, 0.5}, s);
                            }},
                    Variant{"all_at_once", AllAtOnce}),
    [](const auto& one) { return one.param.name; });

}  // namespace
}  // namespace palpate::perception
