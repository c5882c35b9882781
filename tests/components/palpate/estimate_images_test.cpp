// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <utility>

#include "components/palpate/estimate/estimate_verb.hpp"
#include "components/palpate/simulate_verb.hpp"
#include "libs/app/yaml.hpp"
#include "libs/core/error.hpp"
#include "libs/core/file.hpp"
#include "libs/experiment/csv_table.hpp"
#include "libs/experiment/experiment.hpp"
#include "libs/geometry/pose_text.hpp"
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

// One image of a robot at rest, and mistakes in what is said of it.
class EstimateMisfits : public EstimateImages {
 protected:
  EstimateMisfits() {
    std::string scenario = kPush.substr(0, kPush.find("  - {name: a_rest"));
    Simulate(true, scenario + "  - {name: a_rest, kind: rest, duration_s: 0.1}\n");
  }

  std::filesystem::path ExperimentFile() const { return folder_ / "exp/experiment.yaml"; }
  Eigen::Isometry3d TruePose() const {
    return *experiment::ReadExperiment(folder_ / "exp", app::LoadYaml).T_robot_camera;
  }
  void SayPose(const Eigen::Isometry3d& T_robot_camera) const {
    const std::string text = ReadFile(ExperimentFile());
    const auto begin = text.find("T_robot_camera: ");
    const auto end = text.find('\n', begin);
    folder_.Write("exp/experiment.yaml",
                  text.substr(0, begin) +
                      "T_robot_camera: " + geometry::FormatPose(T_robot_camera) + text.substr(end));
  }
  void SayOfCamera(const std::string& old, const std::string& by) const {
    const std::string file = "exp/recordings/a_rest/camera.yaml";
    std::string text = ReadFile(folder_ / file);
    ASSERT_NE(text.find(old), std::string::npos) << text;
    for (auto at = text.find(old); at != std::string::npos; at = text.find(old, at + by.size())) {
      text.replace(at, old.size(), by);
    }
    folder_.Write(file, text);
  }
  void ExpectReason(const std::string& first) const {
    std::string said;
    try {
      Estimate(options_);
      ADD_FAILURE() << "forces of images that do not fit";
    } catch (const RunError& error) {
      said = error.what();
    }
    EXPECT_THAT(said, testing::HasSubstr("a_rest: the images do not fit the robot (misfit "));
    EXPECT_THAT(said, testing::ContainsRegex("no forces were estimated. Likely reasons, the best "
                                             "first:\n  1. " +
                                             first));
    EXPECT_FALSE(std::filesystem::exists(options_.out));
  }
};

TEST_F(EstimateMisfits, ASoundExperimentHasNone) { EXPECT_EQ(Estimate(options_), 0); }

TEST_F(EstimateMisfits, APoseThatIsOffIsNamedWithHowFar) {
  const Eigen::Vector3d middle_m(0.0, 0.0, 0.065);
  SayPose(Eigen::Translation3d(middle_m + Eigen::Vector3d(0.026, 0.0, -0.034)) *
          Eigen::AngleAxisd(0.21, Eigen::Vector3d(0.3, -0.5, 0.8).normalized()) *
          Eigen::Translation3d(-middle_m) * TruePose());
  ExpectReason(
      "pose: T_robot_camera of experiment.yaml puts the robot 4[0-9].[0-9] mm and 1[12].[0-9] "
      "degrees off");
}

TEST_F(EstimateMisfits, APoseThatIsForgottenIsNamed) {
  SayPose(Eigen::Isometry3d::Identity());
  ExpectReason(
      "pose: T_robot_camera of experiment.yaml is the identity: was the camera's pose forgotten");
}

TEST_F(EstimateMisfits, APoseThatIsInvertedIsNamed) {
  SayPose(TruePose().inverse());
  ExpectReason("pose: .*: it is the inverse, T_camera_robot; ");
}

TEST_F(EstimateMisfits, DepthsOfAnotherUnitAreNamed) {
  SayOfCamera("unit_m: 1e-04", "unit_m: 0.001");
  ExpectReason("unit of depth: the depths are 10 times too large: divide unit_m");
}

TEST_F(EstimateMisfits, IntrinsicsOfAnotherResolutionAreNamed) {
  for (const auto& [old, by] : {std::pair{"x_px: 212.5", "x_px: 425"},
                                {"y_px: 212.5", "y_px: 425"},
                                {"211.5", "423.5"},
                                {"119.5", "239.5"}}) {
    SayOfCamera(old, by);
  }
  ExpectReason("intrinsics: .* are those of an image 2 times as wide as its 424 pixels");
}

TEST_F(EstimateMisfits, AnotherRobotIsNamed) {
  options_.robot = "rod";
  ExpectReason("robot: no pose within .* brings the misfit of rod below");
}

}  // namespace
}  // namespace palpate::command
