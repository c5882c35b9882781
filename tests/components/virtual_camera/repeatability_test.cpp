// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

// The same seed and views give the same bits; and what cannot be is refused.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "components/virtual_camera/color_sensor.hpp"
#include "components/virtual_camera/depth_sensor.hpp"
#include "components/virtual_camera/scenery.hpp"
#include "libs/core/error.hpp"
#include "libs/core/instruction_set.hpp"
#include "tests/components/virtual_camera/bench.hpp"

namespace palpate::virtual_camera {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

std::vector<rgbd::RgbdFrame> TakeThree(const scenario::Scenario& scenario, std::uint64_t seed) {
  VirtualCamera camera(scenario, FourLegSurface(), {}, seed);
  std::vector<rgbd::RgbdFrame> frames(3);
  for (rgbd::RgbdFrame& frame : frames) camera.Take(CrowdedView(scenario), &frame);
  return frames;
}

TEST(Repeatability, TheSameSeedGivesTheSameBits) {
  const scenario::Scenario scenario = NoisyScenario();
  const auto once = TakeThree(scenario, 11);
  const auto again = TakeThree(scenario, 11);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(once[i].depth, again[i].depth);
    EXPECT_EQ(once[i].color, again[i].color);
  }
}

TEST(Repeatability, SeedsAndFramesDiffer) {
  const scenario::Scenario scenario = NoisyScenario();
  const auto once = TakeThree(scenario, 11);
  const auto other = TakeThree(scenario, 12);
  EXPECT_NE(once[0].depth, other[0].depth);
  EXPECT_NE(once[0].color, other[0].color);
  EXPECT_NE(once[0].depth, once[1].depth);
  EXPECT_NE(once[0].color, once[1].color);
}

TEST(Repeatability, BuffersOfAnotherFrameAreUsedAgain) {
  const scenario::Scenario scenario = NoisyScenario();
  VirtualCamera camera(scenario, FourLegSurface(), {}, 11);
  rgbd::RgbdFrame frame;
  frame.stamp_ns = 42;
  frame.depth = rgbd::DepthImage(3, 5);
  camera.Take(CrowdedView(scenario), &frame);
  const auto* depth = frame.depth.values.data();
  const auto* color = frame.color.values.data();
  camera.Take(CrowdedView(scenario), &frame);
  EXPECT_EQ(frame.depth.values.data(), depth);
  EXPECT_EQ(frame.color.values.data(), color);
  EXPECT_EQ(frame.stamp_ns, 42);
  EXPECT_EQ(frame.depth, TakeThree(scenario, 11)[1].depth);
}

struct Pictures {
  rgbd::RangeImage truth;
  rgbd::DepthImage depth;
  rgbd::ColorImage color;
};

Pictures DrawWith(const kernels::Kernels& loops, scenario::Scenario scenario, double k1,
                  scenario::DepthSensor sensor) {
  scenario::CameraSpec& spec = *scenario.camera;
  spec.noise.sensor = sensor;
  spec.camera.depth.distortion[0] = k1;
  CameraFaults faults;
  faults.incidence_bias_m = 0.001;
  const View view = CrowdedView(scenario);
  Scenery scenery(scenario, FourLegSurface());
  SceneCamera camera(spec.camera.depth, loops);
  DepthSensor depth(spec, faults, 3, loops);
  ColorSensor color(spec.camera.depth, 3, loops);
  Pictures pictures;
  pictures.truth = rgbd::RangeImage(spec.camera.depth.width_px, spec.camera.depth.height_px);
  for (int frame = 0; frame < 2; ++frame) {
    camera.Look(scenery.Update(view), view.T_robot_camera);
    depth.Measure(&camera, 0.0, &pictures.truth, &pictures.depth);
    color.Expose(&camera, &pictures.color);
  }
  for (float& z : pictures.truth.values) z = std::isnan(z) ? 0.0F : z;  // so that == compares
  return pictures;
}

TEST(Repeatability, EveryInstructionSetGivesTheSameBits) {
  using scenario::DepthSensor;
  const kernels::Kernels* portable = kernels::KernelsOf("portable");
  ASSERT_NE(portable, nullptr);
  for (const double k1 : {0.0, -0.05}) {
    for (const DepthSensor sensor : {DepthSensor::kStereo, DepthSensor::kTimeOfFlight}) {
      const Pictures wanted = DrawWith(*portable, NoisyScenario(), k1, sensor);
      for (const InstructionSet set : AvailableInstructionSets()) {
        const kernels::Kernels* loops = kernels::KernelsOf(ToString(set));
        const Pictures drawn = DrawWith(*loops, NoisyScenario(), k1, sensor);
        EXPECT_EQ(drawn.truth, wanted.truth) << ToString(set) << ", k1 " << k1;
        EXPECT_EQ(drawn.depth, wanted.depth) << ToString(set) << ", k1 " << k1;
        EXPECT_EQ(drawn.color, wanted.color) << ToString(set) << ", k1 " << k1;
      }
    }
  }
}

TEST(Repeatability, AnUnknownInstructionSetHasNoKernels) {
  EXPECT_EQ(kernels::KernelsOf("mmx"), nullptr);
}

template <typename Change>
auto Making(const Change& change) {
  return [change] {
    scenario::Scenario scenario = NoisyScenario();
    RobotSurface surface = FourLegSurface();
    change(&scenario, &surface);
    const VirtualCamera camera(scenario, surface, {}, 1);
  };
}

TEST(Refusals, SayWhatIsWrong) {
  using scenario::Scenario;
  EXPECT_THAT(Making([](Scenario* s, RobotSurface*) { s->camera.reset(); }),
              ThrowsMessage<InputError>(HasSubstr("no camera")));
  EXPECT_THAT(Making([](Scenario* s, RobotSurface*) { s->camera->camera.depth.width_px = 0; }),
              ThrowsMessage<InputError>(HasSubstr("no size")));
  EXPECT_THAT(Making([](Scenario* s, RobotSurface*) { s->camera->camera.color.fx_px = 0.0; }),
              ThrowsMessage<InputError>(HasSubstr("colour camera")));
  EXPECT_THAT(Making([](Scenario* s, RobotSurface*) { s->camera->camera.baseline_m = 0.0; }),
              ThrowsMessage<InputError>(HasSubstr("baseline_m is 0, must be > 0")));
  EXPECT_THAT(Making([](Scenario* s, RobotSurface*) { s->camera->camera.depth_unit_m = 0.0; }),
              ThrowsMessage<InputError>(HasSubstr("depth_unit_m")));
  EXPECT_THAT(Making([](Scenario* s, RobotSurface*) { s->camera->noise.correlation_px = 51.0; }),
              ThrowsMessage<InputError>(HasSubstr("correlation_px is 51")));
  EXPECT_THAT(
      Making([](Scenario* s, RobotSurface*) { s->camera->noise.temporal_correlation = 1.0; }),
      ThrowsMessage<InputError>(HasSubstr("temporal_correlation")));
  EXPECT_THAT(Making([](Scenario* s, RobotSurface*) { s->camera->noise.disparity_step_px = 0.0; }),
              ThrowsMessage<InputError>(HasSubstr("disparity_step_px")));
  EXPECT_THAT(Making([](Scenario*, RobotSurface* k) { k->triangles(0, 0) = 1 << 20; }),
              ThrowsMessage<InputError>(HasSubstr("nodes that it does not have")));
  EXPECT_THAT(Making([](Scenario*, RobotSurface* k) { k->rest_m(0, 0) = std::nan(""); }),
              ThrowsMessage<InputError>(HasSubstr("not numbers")));
}

TEST(Refusals, AToolThatTheScenarioDoesNotHave) {
  const scenario::Scenario scenario = NoisyScenario();
  VirtualCamera camera(scenario, FourLegSurface(), {}, 1);
  View view = RestingView(scenario);
  view.tools = {{"spoon", Eigen::Isometry3d::Identity()}};
  rgbd::RgbdFrame frame;
  EXPECT_THAT([&] { camera.Take(view, &frame); },
              ThrowsMessage<InputError>(HasSubstr("no tool 'spoon'")));
}

}  // namespace
}  // namespace palpate::virtual_camera
