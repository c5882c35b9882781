// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/core/error.hpp"
#include "libs/scenario/scenario_sections.hpp"
#include "tests/components/palpate/look_fixture.hpp"

/// `palpate calibrate` over depth and colour that show coloured markers.
namespace palpate::command {
namespace {

using testing::HasSubstr;

const std::string kGreen = "perception.markers.color_rgb=[0.15, 0.65, 0.3]";
const std::string kLens =
    "{width_px: 640, height_px: 480, fx_px: 425, fy_px: 425, cx_px: 319.5, cy_px: 239.5";
/// Thirteen that face upwards, no turn of which looks like another.
const std::string kMarkers = R"(markers:
  - {name: m1, position_m: [0.003, 0.002, 0.125]}
  - {name: m2, position_m: [0.003, 0.047, 0.098]}
  - {name: m3, position_m: [-0.003, 0.064, 0.08]}
  - {name: m4, position_m: [0.002, 0.084, 0.053]}
  - {name: m5, position_m: [-0.051, 0.003, 0.093]}
  - {name: m6, position_m: [-0.07, 0, 0.071]}
  - {name: m7, position_m: [-0.089, -0.003, 0.045]}
  - {name: m8, position_m: [0, -0.049, 0.095]}
  - {name: m9, position_m: [0.003, -0.074, 0.067]}
  - {name: m10, position_m: [-0.003, -0.092, 0.04]}
  - {name: m11, position_m: [0.045, 0, 0.1]}
  - {name: m12, position_m: [0.06, 0.003, 0.085]}
  - {name: m13, position_m: [0.079, -0.003, 0.06]}
)";
class CalibrateFromFiducials : public LookTest {
 protected:
  CalibrateFromFiducials() {
    const std::size_t begin = robot_text_.find("markers:");
    robot_text_.replace(begin, robot_text_.find("feature_points") - begin, kMarkers);
    options_.robot = folder_.Write("robot.yaml", robot_text_);
    options_.overrides = {kGreen};
  }

  void Simulate() const {
    SimulateScene("stage: {marker_color_rgb: [0.15, 0.65, 0.3]}\ncamera:\n  depth: " + kLens +
                  ", unit_m: 0.0001, baseline_m: 0.05}\n  color: " + kLens +
                  ", registered_to_depth: true}\n  eye_m: [0.12, -0.1, 0.5]\n  target_m: [0, 0, "
                  "0.065]\n  rate_hz: 10\n  noise: {sensor: stereo}\n" +
                  kTwoHolds);
  }

  void ExpectPose() const {
    const robot::CalibrationFile file = Found();
    ASSERT_TRUE(file.pose);
    const Eigen::Vector3d middle_m(0.0, 0.0, 0.065);
    const Eigen::Isometry3d truth = scenario::LookAt({0.12, -0.1, 0.5}, middle_m);
    const Eigen::Isometry3d& found = file.pose->T_robot_camera;
    const Eigen::AngleAxisd turn(found.linear() * truth.linear().transpose());
    EXPECT_LE(turn.angle(), 3.0 * file.pose->rotation_error_rad.norm());
    EXPECT_LE(file.pose->rotation_error_rad.norm(), 0.05);
    // The whole depth image is off by up to 0.3 % (one sigma) of half a metre.
    EXPECT_LE((found * (truth.inverse() * middle_m) - middle_m).norm(), 3.5e-3);
    for (const robot::CalibratedDrive& drive : file.drives) {
      EXPECT_LE(std::abs(drive.drive.offset_m), 4.0 * drive.standard_error.offset_m) << drive.cable;
    }
  }
};

TEST_F(CalibrateFromFiducials, OfOneColourFindTheCameraWithoutARoughPose) {
  Simulate();
  options_.assignment = folder_ / "assignment.svg";
  options_.convergence = folder_ / "convergence.svg";
  testing::internal::CaptureStdout();
  const int code = Calibrate(options_);
  const std::string said = testing::internal::GetCapturedStdout();
  ASSERT_EQ(code, 0);
  EXPECT_THAT(said, testing::ContainsRegex("a_hold: (8|9|10) of 13 markers seen, 0 points"));
  EXPECT_THAT(said, HasSubstr("Algorithm 1: "));
  ExpectPose();
  const std::string svg = ReadFile(options_.assignment);
  EXPECT_THAT(svg, HasSubstr("data:image/png;base64,iVBORw0KGgo")) << "on the camera's picture";
  EXPECT_THAT(svg, HasSubstr("m7 not seen"));
}

TEST_F(CalibrateFromFiducials, NeedNamesThatTheRobotHasOneForEachColour) {
  Simulate();
  options_.overrides = {"perception.markers.color_rgb=[0.15, 0.65, 0.3]",
                        "perception.markers.names=[m1, m2]"};
  EXPECT_THAT(Refusal<InputError>(), HasSubstr("names has 2 markers, color_rgb 1"));
  options_.overrides.back() = "perception.markers.names=[n1]";
  EXPECT_THAT(Refusal<InputError>(), HasSubstr("the robot has no marker 'n1'"));
}

TEST_F(CalibrateFromFiducials, OfAnotherColourAreNotFound) {
  Simulate();
  options_.overrides = {"perception.markers.color_rgb=[0.1, 0.2, 0.9]"};
  EXPECT_THAT(Refusal<RunError>(), HasSubstr("no image shows a fiducial"));
  options_.overrides = {kGreen, "perception.markers.max_radius_m=0.0025"};
  EXPECT_THAT(Refusal<RunError>(), HasSubstr("no image shows a fiducial"));
}

TEST_F(CalibrateFromFiducials, AreNotWhatUnlabelledIsFor) {
  Simulate();
  options_.unlabelled = true;
  EXPECT_THAT(Refusal<InputError>(), HasSubstr("--unlabelled is for markers.csv"));
}

}  // namespace
}  // namespace palpate::command
