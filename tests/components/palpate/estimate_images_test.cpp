// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "components/palpate/estimate/estimate_verb.hpp"
#include "components/palpate/simulate_verb.hpp"
#include "libs/core/file.hpp"
#include "libs/experiment/csv_table.hpp"
#include "tests/components/palpate/test_robot.hpp"

namespace palpate::command {
namespace {

// A ball against the hub's flank that the camera sees, after a rest.
const std::string kPush =
    R"(name: push
body: {mesh_file: )" PALPATE_SOURCE_DIR
    R"(/config/scenarios/four_leg_coarse.msh, refine: 0, element: tet10, material: {youngs_modulus_Pa: 98.0e3}}
motion: {mode: quasi_static, time_step_s: 0.1}
clutter: 0
tools: [{name: ball, shape: sphere, radius_m: 0.010, friction_coefficient: 0.3, color_rgb: [0.15, 0.30, 0.80]}]
camera:
  depth: {width_px: 424, height_px: 240, fx_px: 212.5, fy_px: 212.5, cx_px: 211.5, cy_px: 119.5, unit_m: 0.0001, baseline_m: 0.1}
  color: {width_px: 424, height_px: 240, fx_px: 212.5, fy_px: 212.5, cx_px: 211.5, cy_px: 119.5, registered_to_depth: true}
  eye_m: [0.343, -0.198, 0.275]
  target_m: [0, 0, 0.065]
  rate_hz: 10
  noise: {sensor: stereo}
rest_between_s: 0.5
recordings:
  - {name: a_rest, kind: rest, duration_s: 0.8}
  - name: b_push
    kind: free
    duration_s: 1.2
    tools:
      - tool: ball
        path:
          - {t_s: 0, position_m: [0.0400, -0.0400, 0.103]}
          - {t_s: 0.7, position_m: [0.0220, -0.0220, 0.103]}
          - {t_s: 1.2, position_m: [0.0220, -0.0220, 0.103]}
)";

// The ball also presses in what is said to be a rest.
const std::string kRest = "  - {name: a_rest, kind: rest, duration_s: 0.8}\n";
const std::string kPressedRest = R"(  - name: a_rest
    kind: rest
    duration_s: 1.2
    tools:
      - tool: ball
        path:
          - {t_s: 0, position_m: [0.0400, -0.0400, 0.103]}
          - {t_s: 0.7, position_m: [0.0220, -0.0220, 0.103]}
          - {t_s: 1.2, position_m: [0.0220, -0.0220, 0.103]}
)";

std::string Pressed() {
  std::string scenario = kPush;
  return scenario.replace(scenario.find(kRest), kRest.size(), kPressedRest);
}

class EstimateImages : public testing::Test {
 protected:
  void Simulate(bool tell_camera_pose, const std::string& scenario = kPush) {
    SimulateOptions simulate;
    simulate.robot = "four_leg";
    simulate.scenario = folder_.Write("s.yaml", scenario);
    simulate.seed = 7;
    simulate.out = folder_ / "exp";
    simulate.tell_camera_pose = tell_camera_pose;
    ASSERT_EQ(SimulateOrCheck(simulate), 0);
    options_.robot = "four_leg";
    options_.data = simulate.out;
    options_.out = folder_ / "forces.csv";
  }
  // Rows of a recording as (status, |F|) of the last frame.
  struct Last {
    std::string status;
    double force_N = 0.0;
  };
  Last LastOf(const std::string& recording) const {
    const auto table = experiment::CsvTable::Read(options_.out);
    Last last;
    for (std::size_t row = 0; row < table.rows(); ++row) {
      if (table.Text(row, 0) != recording) continue;
      last.status = table.Text(row, 11);
      last.force_N =
          table.Text(row, 6).empty()
              ? 0.0
              : std::hypot(table.Number(row, 6), table.Number(row, 7), table.Number(row, 8));
    }
    return last;
  }
  double TrueForce_N() const {
    const auto answer = nlohmann::json::parse(ReadFile(folder_ / "exp.answer.json"));
    const auto& frame = answer["recordings"][1]["frames"].back();
    const auto& force_N = frame["forces"][0]["force_N"];
    return std::hypot(force_N[0].get<double>(), force_N[1].get<double>(), force_N[2].get<double>());
  }

  TestFolder folder_;
  EstimateOptions options_;
};

TEST_F(EstimateImages, FindsTheBallsForceAndNothingAtRestTheSameEachTime) {
  Simulate(true);
  ASSERT_EQ(Estimate(options_), 0);
  EXPECT_EQ(LastOf("a_rest").status, "no_contact");
  const Last push = LastOf("b_push");
  EXPECT_THAT(push.status, testing::AnyOf("ok", "tangential_unobservable", "hidden"));
  EXPECT_NEAR(push.force_N, TrueForce_N(), 0.15 * TrueForce_N());
  const std::string first = ReadFile(options_.out);
  ASSERT_EQ(Estimate(options_), 0);
  EXPECT_EQ(ReadFile(options_.out), first);
}

// Its first images are contact-free, which nobody has said.
TEST_F(EstimateImages, OneRecordingAloneGivesItsForces) {
  Simulate(true);
  options_.recordings = {"b_push"};
  std::filesystem::remove_all(folder_ / "exp/recordings/a_rest");
  testing::internal::CaptureStderr();
  ASSERT_EQ(Estimate(options_), 0);
  EXPECT_THAT(testing::internal::GetCapturedStderr(),
              testing::HasSubstr("frames of b_push, in which nothing is seen to touch the robot"));
  EXPECT_NEAR(LastOf("b_push").force_N, TrueForce_N(), 0.15 * TrueForce_N());
}

// The depth bias then comes from the frames before.
TEST_F(EstimateImages, ARestInWhichTheRobotIsTouchedIsNamedAndNotBelieved) {
  Simulate(true, Pressed());
  options_.recordings = {"b_push"};
  testing::internal::CaptureStderr();
  ASSERT_EQ(Estimate(options_), 0);
  const std::string said = testing::internal::GetCapturedStderr();
  EXPECT_THAT(said, testing::HasSubstr("a_rest: something is seen to touch the robot in frame"));
  EXPECT_NEAR(LastOf("b_push").force_N, TrueForce_N(), 0.15 * TrueForce_N());
  // Its own forces end the run with the likely reasons.
  options_.recordings = {"a_rest"};
  testing::internal::CaptureStderr();
  EXPECT_EQ(Estimate(options_), 1);
  EXPECT_THAT(testing::internal::GetCapturedStderr(), testing::HasSubstr("of a rest recording"));
}

TEST_F(EstimateImages, WithoutACameraPoseNothingIsKnownAndTheRunHasFailed) {
  Simulate(false);
  EXPECT_EQ(Estimate(options_), 1);
  EXPECT_EQ(LastOf("a_rest").status, "no_calibration");
  EXPECT_EQ(LastOf("b_push").status, "no_calibration");
}

}  // namespace
}  // namespace palpate::command
