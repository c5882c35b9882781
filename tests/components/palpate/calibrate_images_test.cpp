// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <fstream>
#include <sstream>

#include "libs/core/error.hpp"
#include "libs/geometry/pose_text.hpp"
#include "tests/components/palpate/look_fixture.hpp"

/// `palpate calibrate` over depth and colour without markers.
namespace palpate::command {
namespace {

using testing::HasSubstr;

const std::string kSimulatedCamera = R"(camera:
  depth: {width_px: 424, height_px: 240, fx_px: 212.5, fy_px: 212.5, cx_px: 211.5, cy_px: 119.5, unit_m: 0.0001, baseline_m: 0.1}
  color: {width_px: 424, height_px: 240, fx_px: 212.5, fy_px: 212.5, cx_px: 211.5, cy_px: 119.5, registered_to_depth: true}
  eye_m: [0.343, -0.198, 0.275]
  target_m: [0, 0, 0.065]
  rate_hz: 10
  noise: {sensor: stereo}
)";
/// And one frame of kind free.
const std::string kTwoHoldsAndFree =
    kTwoHolds + "  - {name: c_free, kind: free, duration_s: 0.1}\n";

class CalibrateImages : public LookTest {
 protected:
  void Simulate(const std::string& recordings = kTwoHoldsAndFree) const {
    SimulateScene(kSimulatedCamera + recordings);
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
  void ExpectReason(const std::string& first) const {
    const std::string said = Refusal<RunError>();
    EXPECT_THAT(said, HasSubstr("the images do not fit the robot (misfit "));
    EXPECT_THAT(said, testing::ContainsRegex(
                          "nothing was written. Likely reasons, the best first:\n  1. " + first));
    EXPECT_FALSE(std::filesystem::exists(options_.out));
  }
  static std::string Text(const Eigen::Isometry3d& pose) { return geometry::FormatPose(pose); }
};

TEST_F(CalibrateImages, FindsTheCameraWithinItsStandardErrorsFromARoughPose) {
  Simulate();
  options_.camera_pose = Text(PoseOffBy(0.17, 0.03));
  ASSERT_EQ(Calibrate(options_), 0);
  const robot::CalibrationFile file = Found();
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
  ASSERT_TRUE(file.depth_bias);
  EXPECT_FALSE(file.depth_bias->map.coefficients.isZero());
}

TEST_F(CalibrateImages, TheDepthBiasIsLeftAloneWhereItIsNotWanted) {
  Simulate();
  options_.camera_pose = Text(PoseOffBy(0.0, 0.0));
  options_.no_depth_bias = true;
  ASSERT_EQ(Calibrate(options_), 0);
  EXPECT_FALSE(Found().depth_bias);
  options_.fit_depth_bias = true;
  EXPECT_THAT(Refusal<InputError>(), HasSubstr("exclude each other"));
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
  ExpectReason("pose: --camera-pose ");
}

TEST_F(CalibrateImages, DepthsOfAnotherUnitAreNamed) {
  Simulate();
  options_.camera_pose = Text(PoseOffBy(0.05, 0.01));
  for (const char* name : {"a_hold", "b_hold"}) {
    const auto file = std::string("exp/recordings/") + name + "/camera.yaml";
    std::string text = ReadFile(folder_ / file);
    Replace("unit_m: 1e-04", "unit_m: 0.001", &text);
    folder_.Write(file, text);
  }
  ExpectReason("unit of depth: the depths are 10 times too large: divide unit_m");
}

TEST_F(CalibrateImages, AnotherRobotIsNamed) {
  Simulate("rest_between_s: 0.5\nrecordings:\n  - {name: a_rest, kind: rest, duration_s: 0.1}\n");
  options_.camera_pose = Text(PoseOffBy(0.0, 0.0));
  options_.robot = "rod";
  ExpectReason("robot: no pose within .* brings the misfit of rod below");
}

TEST_F(CalibrateImages, RecordingsInWhichAnythingMayHappenServeNot) {
  Simulate("rest_between_s: 0.5\nrecordings:\n  - {name: c_free, kind: free, duration_s: 0.1}\n");
  options_.camera_pose = Text(PoseOffBy(0.0, 0.0));
  EXPECT_THAT(Refusal<InputError>(), HasSubstr("no recording determines the camera pose"));
}

TEST_F(CalibrateImages, SettingsThatAreNotThereAreRefused) {
  Simulate();
  options_.camera_pose = Text(PoseOffBy(0.0, 0.0));
  options_.overrides = {"perception.robot_colour_rgb=[1, 0, 0]"};
  EXPECT_THAT(Refusal<InputError>(), HasSubstr("did you mean"));
}

/// Images, and motion capture in the camera's frame.
class CalibrateTogetherTest : public CalibrateImages {
 protected:
  CalibrateTogetherTest() { options_.what = "auto"; }

  static std::string Scene() {
    return kSimulatedCamera + "markers: {sigma_m: [0.001, 0.001, 0.001], rate_hz: 30}\n" +
           kTwoHoldsAndFree;
  }
  robot::CalibrationFile CalibrateFrom(const std::string& from) {
    options_.from = from;
    EXPECT_EQ(Calibrate(options_), 0);
    return Found();
  }
  /// Along the camera's x axis.
  void ShiftMarkers(const std::string& recording, double by_m) const {
    const auto file = options_.data / "recordings" / recording / "markers.csv";
    std::istringstream lines(ReadFile(file));
    std::string line, text;
    std::getline(lines, line);
    text = line + "\n";
    while (std::getline(lines, line)) {
      const auto begin = line.find(',', line.find(',') + 1) + 1;
      const auto end = line.find(',', begin);
      const double x_m = std::stod(line.substr(begin, end - begin)) + by_m;
      text += line.substr(0, begin) + std::to_string(x_m) + line.substr(end) + "\n";
    }
    std::ofstream(file) << text;
  }
  static double TranslationError_m(const robot::CalibrationFile& file) {
    return (file.pose->T_robot_camera.translation() - PoseOffBy(0.0, 0.0).translation()).norm();
  }
};

TEST_F(CalibrateTogetherTest, MarkersAndImagesGiveOnePose) {
  SimulateScene(Scene());
  const robot::CalibrationFile markers = CalibrateFrom("markers");
  const robot::CalibrationFile both = CalibrateFrom("");
  ASSERT_TRUE(markers.pose && both.pose);
  EXPECT_FALSE(markers.depth_bias);
  EXPECT_TRUE(both.depth_bias);
  EXPECT_GT(both.degrees_of_freedom, 2 * markers.degrees_of_freedom);
  EXPECT_LT(both.pose->translation_error_m.norm(), markers.pose->translation_error_m.norm());
  EXPECT_LE(TranslationError_m(both), 3.0 * both.pose->translation_error_m.norm());
}

TEST_F(CalibrateTogetherTest, WhatContradictsIsRefused) {
  SimulateScene(Scene());
  for (const char* name : {"a_hold", "b_hold"}) ShiftMarkers(name, 0.03);
  EXPECT_THAT(Refusal<RunError>(), HasSubstr("markers and images contradict each other"));
  EXPECT_FALSE(std::filesystem::exists(options_.out));
}

TEST_F(CalibrateTogetherTest, ImagesWithoutTheRobotAreRefused) {
  SimulateScene(Scene());
  options_.overrides = {"perception.robot_color_rgb=[0, 0, 1]"};
  EXPECT_THAT(Refusal<RunError>(), HasSubstr("Give --from markers"));
}

}  // namespace
}  // namespace palpate::command
