// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <string>

#include "components/palpate/diagnose/force_gain.hpp"
#include "components/palpate/simulate_verb.hpp"
#include "libs/app/yaml.hpp"
#include "libs/experiment/experiment.hpp"
#include "libs/robot/robot_description.hpp"
#include "tests/components/palpate/test_robot.hpp"
#include "tests/support/robots.hpp"

namespace palpate::command {
namespace {

constexpr double kTrueModulus_Pa = 70e3;

/// Weights on the hub of a soft robot that a camera sees, after a rest.
const std::string kWeights =
    R"(name: weights
body: {mesh_file: )" PALPATE_SOURCE_DIR
    R"(/config/scenarios/four_leg_coarse.msh, refine: 0, element: tet10, material: {youngs_modulus_Pa: 70.0e3}}
motion: {mode: quasi_static, time_step_s: 0.1}
clutter: 0
camera:
  depth: {width_px: 424, height_px: 240, fx_px: 212.5, fy_px: 212.5, cx_px: 211.5, cy_px: 119.5, unit_m: 0.0001, baseline_m: 0.1}
  color: {width_px: 424, height_px: 240, fx_px: 212.5, fy_px: 212.5, cx_px: 211.5, cy_px: 119.5, registered_to_depth: true}
  eye_m: [0.343, -0.198, 0.275]
  target_m: [0, 0, 0.065]
  rate_hz: 10
  noise: {sensor: stereo}
stage: {marker_radius_m: 0}
rest_between_s: 0.5
recordings:
  - {name: a_rest, kind: rest, duration_s: 0.8}
  - name: b_weight
    kind: known_load
    duration_s: 1.5
    weights: [{t_s: 0.4, position_m: [0, 0, 0.125], mass_kg: 0.05, patch_radius_m: 0.008}]
)";

/// Markers are not needed. With a modulus that is 43 % too large the weight feels so much heavier.
TEST(ForceGain, IsMeasuredFromImages) {
  const TestFolder folder;
  SimulateOptions simulate;
  simulate.robot = "four_leg";
  simulate.scenario = folder.Write("s.yaml", kWeights);
  simulate.seed = 7;
  simulate.out = folder / "exp";
  simulate.tell_camera_pose = true;
  ASSERT_EQ(SimulateOrCheck(simulate), 0);
  auto experiment = experiment::ReadExperiment(folder / "exp", app::LoadYaml);
  ASSERT_FALSE(experiment.recordings[1].markers);
  const auto as_built = robot::ReadRobotFile(test_support::RobotFile("four_leg"), app::LoadYaml);
  diagnosis::Diagnosis diagnosis;
  diagnosis.result.causes.resize(1);
  diagnosis.extended = as_built;
  diagnosis.extended.material.youngs_modulus_Pa = kTrueModulus_Pa;
  const auto error = MeasureForceError(as_built, diagnosis, experiment, 2, {});
  EXPECT_EQ(error.why_not, "");
  EXPECT_EQ(error.recordings, 1);
  EXPECT_GE(error.forces, 8);
  EXPECT_LT(error.after_N, 0.7 * error.before_N);
  experiment.T_robot_camera.reset();
  EXPECT_EQ(MeasureForceError(as_built, diagnosis, experiment, 2, {}).forces, 0);
}

}  // namespace
}  // namespace palpate::command
