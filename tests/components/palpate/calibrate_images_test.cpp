// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "components/palpate/calibrate/calibrate_verb.hpp"
#include "components/palpate/simulate_verb.hpp"
#include "libs/app/yaml.hpp"
#include "libs/core/error.hpp"
#include "libs/core/file.hpp"
#include "libs/geometry/pose_text.hpp"
#include "libs/robot/calibration_file.hpp"
#include "tests/components/palpate/test_robot.hpp"

/// `palpate calibrate` over depth and colour without markers.
namespace palpate::command {
namespace {

using testing::HasSubstr;

const std::string kMesh = PALPATE_SOURCE_DIR "/config/scenarios/four_leg_coarse.msh";
const std::string kCamera = R"(camera:
  depth: {width_px: 424, height_px: 240, fx_px: 212.5, fy_px: 212.5, cx_px: 211.5, cy_px: 119.5, unit_m: 0.0001, baseline_m: 0.1}
  color: {width_px: 424, height_px: 240, fx_px: 212.5, fy_px: 212.5, cx_px: 211.5, cy_px: 119.5, registered_to_depth: true}
  eye_m: [0.343, -0.198, 0.275]
  target_m: [0, 0, 0.065]
  rate_hz: 10
  noise: {sensor: stereo}
)";
/// Two settings of the cables, and one frame in which nobody says what happens.
const std::string kRecordings = R"(rest_between_s: 0.5
recordings:
  - name: a_hold
    kind: hold
    duration_s: 0.1
    commands: [{t_s: 0, north.displacement_m: 0.004, west.displacement_m: 0.006, south.displacement_m: 0.008, east.displacement_m: 0.004}]
  - name: b_hold
    kind: hold
    duration_s: 0.1
    commands: [{t_s: 0, north.displacement_m: 0.008, west.displacement_m: 0.004, south.displacement_m: 0.004, east.displacement_m: 0.006}]
  - {name: c_free, kind: free, duration_s: 0.1}
)";

class CalibrateImages : public testing::Test {
 protected:
  CalibrateImages() {
    std::string robot = ReadFile(PALPATE_SOURCE_DIR "/config/robots/four_leg.yaml");
    Replace("file: four_leg.msh", "file: " + kMesh, &robot);
    Replace("element: tet10", "element: tet4", &robot);
    options_.robot = folder_.Write("robot.yaml", robot);
    options_.data = folder_ / "exp";
    options_.out = folder_ / "calibration.yaml";
    options_.what = "camera";
  }

  static void Replace(const std::string& old, const std::string& by, std::string* text) {
    ASSERT_NE(text->find(old), std::string::npos) << old;
    text->replace(text->find(old), old.size(), by);
  }

  void Simulate(const std::string& recordings = kRecordings) const {
    SimulateOptions simulate;
    simulate.robot = options_.robot;
    simulate.scenario =
        folder_.Write("s.yaml", "name: look\nbody: {mesh_file: " + kMesh +
                                    ", refine: 0, element: tet4}\nmotion: {mode: quasi_static, "
                                    "time_step_s: 0.1}\nclutter: 0\n" +
                                    kCamera + recordings);
    simulate.seed = 3;
    simulate.out = options_.data;
    ASSERT_EQ(SimulateOrCheck(simulate), 0);
  }

  /// The scenario's camera, turned about the robot's middle and shifted.
  static Eigen::Isometry3d PoseOffBy(double turn_rad, double shift_m) {
    const Eigen::Vector3d eye_m(0.343, -0.198, 0.275), middle_m(0.0, 0.0, 0.065);
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.translation() = eye_m;
    Eigen::Matrix3d R;
    R.col(2) = (middle_m - eye_m).normalized();
    R.col(0) = R.col(2).cross(Eigen::Vector3d::UnitZ()).normalized();
    R.col(1) = R.col(2).cross(R.col(0));
    T.linear() = R;
    return Eigen::Translation3d(middle_m + shift_m * Eigen::Vector3d(0.6, 0.0, -0.8)) *
           Eigen::AngleAxisd(turn_rad, Eigen::Vector3d(0.3, -0.5, 0.8).normalized()) *
           Eigen::Translation3d(-middle_m) * T;
  }
  static std::string Text(const Eigen::Isometry3d& pose) { return geometry::FormatPose(pose); }

  template <typename Error>
  std::string Refusal() const {
    try {
      Calibrate(options_);
    } catch (const Error& error) {
      return error.what();
    }
    ADD_FAILURE() << "nothing was refused";
    return {};
  }

  TestFolder folder_;
  CalibrateOptions options_;
};

TEST_F(CalibrateImages, FindsTheCameraWithinItsStandardErrorsFromARoughPose) {
  Simulate();
  options_.camera_pose = Text(PoseOffBy(0.17, 0.03));
  ASSERT_EQ(Calibrate(options_), 0);
  const auto file = robot::ReadCalibrationFile(options_.out, app::LoadYaml);
  ASSERT_TRUE(file.pose);
  const Eigen::Isometry3d truth = PoseOffBy(0.0, 0.0);
  const Eigen::Isometry3d& found = file.pose->T_robot_camera;
  const double turn_rad = Eigen::AngleAxisd(found.linear() * truth.linear().transpose()).angle();
  const Eigen::Vector3d middle_m(0.0, 0.0, 0.065);
  const double shift_m = (found * (truth.inverse() * middle_m) - middle_m).norm();
  EXPECT_LE(turn_rad, 3.0 * file.pose->rotation_error_rad.norm());
  EXPECT_LE(shift_m, 1.5e-3);
  EXPECT_LE((found.translation() - truth.translation()).norm(),
            3.0 * file.pose->translation_error_m.norm());
  EXPECT_LE(file.pose->rotation_error_rad.norm(), 0.03);
  EXPECT_THAT(file.data, HasSubstr("b_hold"));
  EXPECT_THAT(file.data, testing::Not(HasSubstr("c_free")));
}

TEST_F(CalibrateImages, ARoughPoseIsNeeded) {
  Simulate();
  EXPECT_THAT(Refusal<InputError>(), HasSubstr("--camera-pose"));
  options_.from = "markers";
  EXPECT_THAT(Refusal<InputError>(), HasSubstr("needs markers.csv"));
  options_.camera_pose = Text(PoseOffBy(0.0, 0.0));
  EXPECT_THAT(Refusal<InputError>(), HasSubstr("--camera-pose is for images"));
}

TEST_F(CalibrateImages, APoseThatIsTooFarOffIsRefused) {
  Simulate();
  options_.camera_pose = Text(PoseOffBy(1.2, 0.1));
  EXPECT_THAT(Refusal<RunError>(), testing::AnyOf(HasSubstr("perception sees the robot in no"),
                                                  HasSubstr("not_converged")));
  EXPECT_FALSE(std::filesystem::exists(options_.out));
}

TEST_F(CalibrateImages, RecordingsInWhichAnythingMayHappenServeNot) {
  Simulate("rest_between_s: 0.5\nrecordings:\n  - {name: c_free, kind: free, duration_s: 0.1}\n");
  options_.camera_pose = Text(PoseOffBy(0.0, 0.0));
  EXPECT_THAT(Refusal<InputError>(), HasSubstr("no recording serves to find the camera"));
}

TEST_F(CalibrateImages, SettingsThatAreNotThereAreRefused) {
  Simulate();
  options_.camera_pose = Text(PoseOffBy(0.0, 0.0));
  options_.overrides = {"perception.robot_colour_rgb=[1, 0, 0]"};
  EXPECT_THAT(Refusal<InputError>(), HasSubstr("did you mean"));
}

}  // namespace
}  // namespace palpate::command
