// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/benchmarks/camera_bench.hpp"

#include <memory>
#include <utility>

#include "components/virtual_camera/virtual_camera.hpp"
#include "tests/benchmarks/lazy.hpp"
#include "tests/benchmarks/robots.hpp"
#include "tests/support/sensing/drawn_robot.hpp"

namespace palpate::benchmarks {

namespace {

struct CameraSettings {
  bool noise = true;
  bool color = true;
  bool distortion = false;
  scenario::ToolShape tool = scenario::ToolShape::kSphere;
};

scenario::Scenario MakeScenario(const CameraSettings& settings) {
  scenario::Scenario scenario =
      test_support::StereoScenario(665.0, 0.055, {0.12, -0.45, 0.30}, {0.0, 0.0, 0.05});
  scenario::CameraSpec& spec = *scenario.camera;
  if (settings.distortion) {
    spec.camera.depth.distortion[0] = spec.camera.color.distortion[0] = -0.05;
  }
  if (!settings.color) spec.camera.color = {};
  spec.camera.T_depth_color.translation() = Eigen::Vector3d(0.015, 0.0, 0.0);
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
    virtual_camera::RobotSurface surface =
        test_support::SkinOf(BuildBody(OwnRobot("four_leg", fem::ElementType::kTet10)));
    view = test_support::ViewWithTool(scenario, surface, "tool", {0.10, -0.02, 0.15});
    camera = std::make_unique<virtual_camera::VirtualCamera>(
        scenario, std::move(surface), std::vector<scenario::ActiveEffect>{}, 1);
  }

  virtual_camera::View view;
  std::unique_ptr<virtual_camera::VirtualCamera> camera;
  rgbd::RgbdFrame frame;
};

Benchmark MakeCameraBenchmark(const char* name, const CameraSettings& settings) {
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
          .benchmarks = {MakeCameraBenchmark("depth_and_color", {}),
                         MakeCameraBenchmark("depth_and_color_with_hand",
                                             {.tool = scenario::ToolShape::kHand}),
                         MakeCameraBenchmark("depth_and_color_without_noise", {.noise = false}),
                         MakeCameraBenchmark("depth", {.color = false}),
                         MakeCameraBenchmark("depth_and_color_distorted", {.distortion = true})}};
}

}  // namespace palpate::benchmarks
