// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

// True depth without noise against Embree, an independent ray caster.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "components/virtual_camera/scene_camera.hpp"
#include "components/virtual_camera/scenery.hpp"
#include "tests/components/virtual_camera/bench.hpp"
#include "tests/components/virtual_camera/embree_oracle.hpp"

namespace palpate::virtual_camera {
namespace {

rgbd::RangeImage RangeSeenBy(const Drawing& drawing, const rgbd::CameraModel& model,
                             const Eigen::Isometry3d& T_robot_camera) {
  SceneCamera camera(model, kernels::BestKernels());
  camera.Look(drawing, T_robot_camera);
  rgbd::RangeImage range(model.width_px, model.height_px);
  for (int v = 0; v < model.height_px; ++v) {
    kernels::BestKernels().range_row(camera.z_buffer().InverseZ(v), model.width_px,
                                     range.Pixel(0, v));
  }
  return range;
}

// Compares with Embree; at most `silhouette` pixels may be right only for a ray within 1e-3 px.
// `from_inside`: surfaces that are cut open show their inside, as Embree has it.
void ExpectAsEmbree(const rgbd::CameraModel& model, const View& view, int silhouette,
                    bool from_inside = false) {
  Scenery scenery(QuietScenario(), FourLegSurface());
  Drawing drawing = scenery.Update(view);
  for (DrawnMesh& mesh : drawing.meshes) mesh.closed = mesh.closed && !from_inside;
  const EmbreeOracle oracle(drawing, view.T_robot_camera);
  const Comparison result = CompareWithEmbree(RangeSeenBy(drawing, model, view.T_robot_camera),
                                              model, oracle, kNearest_m);
  EXPECT_EQ(result.wrong, 0) << result.first_wrong;
  EXPECT_LE(result.silhouette, silhouette);
  EXPECT_GT(result.pixels, model.width_px * model.height_px / 2);
  EXPECT_LT(result.largest_m, 1e-5);
  ::testing::Test::RecordProperty("largest_um", std::to_string(1e6 * result.largest_m));
  ::testing::Test::RecordProperty("silhouette_px", result.silhouette);
}

TEST(Geometry, NoPixelIsOffByAHundredthOfAMillimetre) {
  const scenario::Scenario scenario = QuietScenario();
  ExpectAsEmbree(scenario.camera->camera.depth, CrowdedView(scenario), 100);
}

TEST(Geometry, HoldsFromCloseAndAtAnAngle) {
  const scenario::Scenario scenario = QuietScenario();
  View view = CrowdedView(scenario);
  view.T_robot_camera = scenario::LookAt({-0.13, -0.12, 0.02}, {0.03, 0.02, 0.06});
  ExpectAsEmbree(scenario.camera->camera.depth, view, 100);
}

TEST(Geometry, CutsWhatReachesBehindTheCamera) {
  const scenario::Scenario scenario = QuietScenario();
  View view = CrowdedView(scenario);
  // 3 mm over the table, which goes on behind the camera: it begins in the picture, 10 mm away.
  view.T_robot_camera = scenario::LookAt({0.02, -0.08, 0.003}, {-0.01, 0.2, 0.003});
  ExpectAsEmbree(scenario.camera->camera.depth, view, 100, true);
}

TEST(Geometry, MeetsTheTrueRayOfADistortedLens) {
  const scenario::Scenario scenario = QuietScenario();
  rgbd::CameraModel model = scenario.camera->camera.depth;
  for (const double k1 : {-0.18, 0.12}) {
    model.distortion = {k1, 0.03, 0.002, -0.003, 0.001};
    ExpectAsEmbree(model, CrowdedView(scenario), 100);
  }
}

TEST(Geometry, CutsWhatReachesBehindADistortedLens) {
  const scenario::Scenario scenario = QuietScenario();
  rgbd::CameraModel model = scenario.camera->camera.depth;
  model.distortion = {-0.1, 0.02, 0.001, 0.001, 0.0};
  View view = CrowdedView(scenario);
  view.T_robot_camera = scenario::LookAt({0.02, -0.08, 0.003}, {-0.01, 0.2, 0.003});
  ExpectAsEmbree(model, view, 100, true);
}

TEST(Geometry, ADistortionTooSmallToSeeIsDrawnAsNone) {
  const scenario::Scenario scenario = QuietScenario();
  const View view = CrowdedView(scenario);
  Scenery scenery(scenario, FourLegSurface());
  const Drawing& drawing = scenery.Update(view);
  rgbd::CameraModel model = scenario.camera->camera.depth;
  const rgbd::RangeImage straight = RangeSeenBy(drawing, model, view.T_robot_camera);
  model.distortion[0] = 1e-12;
  const rgbd::RangeImage by_ray = RangeSeenBy(drawing, model, view.T_robot_camera);
  int different = 0;
  for (std::size_t i = 0; i < straight.values.size(); ++i) {
    const float a = straight.values[i];
    const float b = by_ray.values[i];
    different += (std::isnan(a) && std::isnan(b)) || std::abs(a - b) < 1e-6F ? 0 : 1;
  }
  EXPECT_LE(different, 10);
}

}  // namespace
}  // namespace palpate::virtual_camera
