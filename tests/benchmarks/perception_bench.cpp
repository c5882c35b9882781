// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/benchmarks/perception_bench.hpp"

#include <array>
#include <memory>
#include <utility>

#include "components/perception/model/model_segmenter.hpp"
#include "components/perception/registered_frame.hpp"
#include "components/virtual_camera/virtual_camera.hpp"
#include "tests/benchmarks/lazy.hpp"
#include "tests/benchmarks/robots.hpp"
#include "tests/support/sensing/drawn_robot.hpp"

namespace palpate::benchmarks {

namespace {

struct PerceptionSettings {
  bool registered = true;
  bool predicted = true;
  double focal_px = 425.0;
};

scenario::Scenario MakeScenario(const PerceptionSettings& settings) {
  scenario::Scenario scenario = test_support::StereoScenario(
      settings.focal_px, 0.05, {0.343, -0.198, 0.275}, {0.0, 0.0, 0.065});
  rgbd::RgbdCamera& camera = scenario.camera->camera;
  camera.color_registered = settings.registered;
  if (!settings.registered) camera.T_depth_color.translation() = Eigen::Vector3d(0.015, 0.0, 0.0);
  scenario.tools.emplace_back().name = "ball";
  return scenario;
}

// Some frames in turn, and where the robot is in them.
struct PerceptionScene {
  explicit PerceptionScene(const PerceptionSettings& settings) {
    const scenario::Scenario scenario = MakeScenario(settings);
    virtual_camera::RobotSurface skin =
        test_support::SkinOf(BuildBody(OwnRobot("four_leg", fem::ElementType::kTet10)));
    const virtual_camera::View view =
        test_support::ViewWithTool(scenario, skin, "ball", {0.03, -0.03, 0.11});
    predicted.vertices_m = scenario.camera->T_robot_camera.inverse() * skin.rest_m;
    predicted.triangles = skin.triangles;
    virtual_camera::VirtualCamera eye(scenario, std::move(skin), {}, 1);
    for (rgbd::RgbdFrame& frame : frames) eye.Take(view, &frame);
    camera = scenario.camera->camera;
    segmenter.SetCamera(camera);
    registration = std::make_unique<perception::Registration>(camera);
    segmenter.Segment(frames[0], &predicted);
  }

  const rgbd::RgbdFrame& Next() { return frames[++taken % frames.size()]; }

  std::array<rgbd::RgbdFrame, 8> frames;
  std::size_t taken = 0;
  rgbd::RgbdCamera camera;
  perception::PredictedSurface predicted;
  perception::ModelSegmenter segmenter{perception::Config()};
  std::unique_ptr<perception::Registration> registration;
  perception::RegisteredFrame registered;
};

Benchmark SegmentationBenchmark(const char* name, const PerceptionSettings& settings) {
  const auto scene =
      MakeLazy<PerceptionScene>([settings] { return std::make_unique<PerceptionScene>(settings); });
  return {.name = std::string("perception/") + name,
          .measure =
              [scene, settings](benchmark::State& state) {
                PerceptionScene& bench = scene->Get();
                const auto* predicted = settings.predicted ? &bench.predicted : nullptr;
                for (int warm = 0; warm < 3; ++warm) {
                  bench.segmenter.Segment(bench.Next(), predicted);
                }
                for ([[maybe_unused]] auto iteration : state) {
                  benchmark::DoNotOptimize(&bench.segmenter.Segment(bench.Next(), predicted));
                }
              },
          .max_repetitions = 300};
}

Benchmark RegistrationBenchmark(const char* name, const PerceptionSettings& settings) {
  const auto scene =
      MakeLazy<PerceptionScene>([settings] { return std::make_unique<PerceptionScene>(settings); });
  return {.name = std::string("perception/") + name,
          .measure =
              [scene](benchmark::State& state) {
                PerceptionScene& bench = scene->Get();
                for ([[maybe_unused]] auto iteration : state) {
                  const Status status =
                      bench.registration->Register(bench.Next(), &bench.registered);
                  benchmark::DoNotOptimize(status.ok());
                }
              },
          .max_repetitions = 300};
}

}  // namespace

Block PerceptionBlock() {
  return {
      .heading = "perception, 848x480, four_leg_tet10 (8792 triangles) at 0.45 m",
      .benchmarks = {SegmentationBenchmark("segment_by_model", {}),
                     SegmentationBenchmark("segment_by_model_color_camera", {.registered = false}),
                     SegmentationBenchmark("segment_by_model_near", {.focal_px = 665.0}),
                     SegmentationBenchmark("segment_without_prediction", {.predicted = false}),
                     RegistrationBenchmark("register", {}),
                     RegistrationBenchmark("register_color_camera", {.registered = false})}};
}

}  // namespace palpate::benchmarks
