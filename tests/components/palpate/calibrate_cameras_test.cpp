// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <Eigen/Geometry>
#include <string>

#include "libs/geometry/pose_text.hpp"
#include "tests/components/palpate/look_fixture.hpp"

/// `palpate calibrate` over the images of two cameras, from rough poses of both.
namespace palpate::command {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// Where config/scenarios/two_cameras.yaml has them, with smaller images and more of the robot.
const std::string kTwoCameras = R"(camera:
  depth: {width_px: 424, height_px: 240, fx_px: 212.5, fy_px: 212.5, cx_px: 211.5, cy_px: 119.5, unit_m: 0.0001, baseline_m: 0.1}
  color: {width_px: 424, height_px: 240, fx_px: 212.5, fy_px: 212.5, cx_px: 211.5, cy_px: 119.5, registered_to_depth: true}
  eye_m: [0.343, -0.198, 0.275]
  target_m: [0, 0, 0.065]
  rate_hz: 10
  noise: {sensor: stereo}
cameras:
  - name: back
    delay_s: 0.012
    clock_offset_s: 0.25
    depth: {width_px: 424, height_px: 240, fx_px: 212.5, fy_px: 212.5, cx_px: 211.5, cy_px: 119.5, unit_m: 0.0001, baseline_m: 0.1}
    color: {width_px: 424, height_px: 240, fx_px: 212.5, fy_px: 212.5, cx_px: 211.5, cy_px: 119.5, registered_to_depth: true}
    eye_m: [-0.343, 0.198, 0.275]
    target_m: [0, 0, 0.065]
    rate_hz: 10
    noise: {sensor: stereo}
)";
const Eigen::Vector3d kMiddle_m(0.0, 0.0, 0.065);

Eigen::Isometry3d LookFrom(const Eigen::Vector3d& eye_m) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() = eye_m;
  Eigen::Matrix3d R;
  R.col(2) = (kMiddle_m - eye_m).normalized();
  R.col(0) = R.col(2).cross(Eigen::Vector3d::UnitZ()).normalized();
  R.col(1) = R.col(2).cross(R.col(0));
  T.linear() = R;
  return T;
}

/// Turned about the robot's middle and shifted.
Eigen::Isometry3d OffBy(double turn_rad, double shift_m, const Eigen::Isometry3d& T) {
  return Eigen::Translation3d(kMiddle_m + shift_m * Eigen::Vector3d(0.6, 0.0, -0.8)) *
         Eigen::AngleAxisd(turn_rad, Eigen::Vector3d(0.3, -0.5, 0.8).normalized()) *
         Eigen::Translation3d(-kMiddle_m) * T;
}

class CalibrateCameras : public LookTest {
 protected:
  /// The approximate pose of the second camera in experiment.yaml; empty: none.
  void SetBack(const std::string& pose) const {
    const auto file = options_.data / "experiment.yaml";
    std::string text = ReadFile(file);
    const std::size_t begin = text.find("cameras:\n");
    ASSERT_NE(begin, std::string::npos) << text;
    std::size_t end = text.find('\n', begin) + 1;
    while (end < text.size() && text[end] == ' ') end = text.find('\n', end) + 1;
    const std::string settings = "cameras:\n  - name: back\n    clock_offset_s: 0.25\n" +
                                 (pose.empty() ? "" : "    T_robot_camera: " + pose + "\n");
    WriteFile(file, text.replace(begin, end - begin, settings));
  }

  static void ExpectNear(const robot::CalibratedPose& pose, const Eigen::Isometry3d& truth) {
    const Eigen::Isometry3d& found = pose.T_robot_camera;
    const double turn_rad = Eigen::AngleAxisd(found.linear() * truth.linear().transpose()).angle();
    EXPECT_LE(turn_rad, 3.0 * pose.rotation_error_rad.norm());
    EXPECT_LE((found * (truth.inverse() * kMiddle_m) - kMiddle_m).norm(), 1.5e-3);
    EXPECT_LE((found.translation() - truth.translation()).norm(),
              3.0 * pose.translation_error_m.norm());
    EXPECT_LE(pose.rotation_error_rad.norm(), 0.03);
  }

  const Eigen::Isometry3d front_ = LookFrom({0.343, -0.198, 0.275});
  const Eigen::Isometry3d back_ = LookFrom({-0.343, 0.198, 0.275});
};

/// The tolerances are those of one camera (CalibrateImages).
TEST_F(CalibrateCameras, BothAreFoundWithinTheirStandardErrorsFromRoughPoses) {
  SimulateScene(kTwoCameras + kTwoHolds);
  options_.camera_pose = geometry::FormatPose(OffBy(0.17, 0.03, front_));
  SetBack(geometry::FormatPose(OffBy(-0.15, 0.03, back_), geometry::PoseStandardError{0.05, 0.2}));
  testing::internal::CaptureStdout();
  ASSERT_EQ(Calibrate(options_), 0);
  EXPECT_THAT(testing::internal::GetCapturedStdout(),
              AllOf(HasSubstr("all cameras in one fit:"), HasSubstr("camera 'back', b_hold: ")));
  const robot::CalibrationFile file = Found();
  ASSERT_TRUE(file.pose);
  ExpectNear(*file.pose, front_);
  ASSERT_EQ(file.cameras.size(), 1U);
  EXPECT_EQ(file.cameras[0].name, "back");
  ExpectNear(file.cameras[0].pose, back_);
  ASSERT_TRUE(file.depth_bias && file.cameras[0].depth_bias);
  EXPECT_NE(file.depth_bias->map.coefficients, file.cameras[0].depth_bias->map.coefficients);
}

TEST_F(CalibrateCameras, WithoutAnApproximatePoseACameraIsLeftOutAndThatIsSaid) {
  SimulateScene(kTwoCameras + kTwoHolds);
  options_.camera_pose = geometry::FormatPose(front_);
  SetBack("");
  testing::internal::CaptureStderr();
  ASSERT_EQ(Calibrate(options_), 0);
  EXPECT_THAT(testing::internal::GetCapturedStderr(),
              HasSubstr("camera 'back' is not calibrated: give its approximate pose"));
  EXPECT_TRUE(Found().cameras.empty());
}

}  // namespace
}  // namespace palpate::command
