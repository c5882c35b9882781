// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/benchmarks/camera_bench.hpp"

#include <memory>
#include <utility>

#include "components/virtual_camera/virtual_camera.hpp"
#include "libs/scenario/scenario_sections.hpp"
#include "tests/benchmarks/lazy.hpp"
#include "tests/benchmarks/robots.hpp"

namespace palpate::benchmarks {

namespace {

struct CameraSettings {
  bool noise = true;
  bool color = true;
  bool distortion = false;
  scenario::ToolShape tool = scenario::ToolShape::kSphere;
};

scenario::Scenario MakeScenario(const CameraSettings& settings) {
  scenario::Scenario scenario;
  scenario::CameraSpec& spec = scenario.camera.emplace();
  spec.camera.depth = {.width_px = 848,
                       .height_px = 480,
                       .fx_px = 665.0,
                       .fy_px = 665.0,
                       .cx_px = 423.5,
                       .cy_px = 239.5};
  if (settings.distortion) spec.camera.depth.distortion[0] = -0.05;
  spec.camera.baseline_m = 0.055;
  if (settings.color) spec.camera.color = spec.camera.depth;
  spec.camera.T_depth_color.translation() = Eigen::Vector3d(0.015, 0.0, 0.0);
  spec.T_robot_camera = scenario::LookAt({0.12, -0.45, 0.30}, {0.0, 0.0, 0.05});
  if (!settings.noise) spec.noise.sensor = scenario::DepthSensor::kNone;
  scenario::Tool& tool = scenario.tools.emplace_back();
  tool.name = "tool";
  tool.shape = settings.tool;
  return scenario;
}

// A camera, and what it takes again and again.
struct CameraScene {
  explicit CameraScene(const CameraSettings& settings) {
    const scenario::Scenario scenario = MakeScenario(settings);
    const robot::RobotBody body = BuildBody(OwnRobot("four_leg", fem::ElementType::kTet10));
    virtual_camera::Skin skin;
    skin.rest_m = body.mesh.nodes_m;
    skin.triangles = body.boundary.DrawnTriangles();
    skin.markers_m = Eigen::Vector3d(0.0, 0.0, 0.125);
    view.nodes_m = skin.rest_m;
    view.T_robot_camera = scenario.camera->T_robot_camera;
    view.tools.resize(1);
    view.tools[0].tool = "tool";
    view.tools[0].T_robot_tool.translation() = Eigen::Vector3d(0.10, -0.02, 0.15);
    camera = std::make_unique<virtual_camera::VirtualCamera>(
        scenario, std::move(skin), std::vector<scenario::ActiveEffect>{}, 1);
  }

  virtual_camera::View view;
  std::unique_ptr<virtual_camera::VirtualCamera> camera;
  rgbd::RgbdFrame frame;
};

Benchmark MakeBenchmark(const char* name, const CameraSettings& settings) {
  const auto scene =
      MakeLazy<CameraScene>([settings] { return std::make_unique<CameraScene>(settings); });
  return {.name = std::string("camera/") + name,
          .measure =
              [scene](benchmark::State& state) {
                CameraScene& bench = scene->Get();
                for (int warm = 0; warm < 3; ++warm) bench.camera->Take(bench.view, &bench.frame);
                for ([[maybe_unused]] auto iteration : state) {
                  bench.camera->Take(bench.view, &bench.frame);
                }
              },
          .max_repetitions = 300};
}

}  // namespace

Block CameraBlock() {
  return {.heading = "virtual camera, 848x480, four_leg_tet10 (8792 triangles)",
          .benchmarks = {
              MakeBenchmark("depth_and_color", {}),
              MakeBenchmark("depth_and_color_with_hand", {.tool = scenario::ToolShape::kHand}),
              MakeBenchmark("depth_and_color_without_noise", {.noise = false}),
              MakeBenchmark("depth", {.color = false}),
              MakeBenchmark("depth_and_color_distorted", {.distortion = true})}};
}

}  // namespace palpate::benchmarks
