// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>

#include "components/calibration/joint/request_after.hpp"
#include "components/calibration/live/earlier_calibration.hpp"
#include "components/calibration/live/live_calibration.hpp"
#include "tests/components/calibration/cloud/cloud_scene.hpp"

/// Clouds of two cameras calibrate both and the robot.
namespace palpate::calibration {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr double kZeroOffset_m = 1e-3;

geometry::RigidTransform BackPose() { return LookAt({-0.343, 0.198, 0.275}, {0.0, 0.0, 0.065}); }

geometry::RigidTransform ToRigid(const Eigen::Isometry3d& T) {
  return {Eigen::Quaterniond(T.linear()), T.translation()};
}

class LiveClouds : public ::testing::Test {
 protected:
  /// Three settings of actuators that count from kZeroOffset_m, seen by both cameras.
  LiveClouds() {
    back_.name = "back";
    for (const std::vector<double>& told_m :
         std::vector<std::vector<double>>{{0.006, 0.004, 0.010, 0.004},
                                          {0.010, 0.004, 0.004, 0.011},
                                          {0.005, 0.012, 0.006, 0.006}}) {
      std::vector<double> truth_m = told_m;
      for (double& pull_m : truth_m) pull_m += kZeroOffset_m;
      const std::string name = "frame " + std::to_string(job_.clouds.size() + 1);
      job_.clouds.push_back(SeeCloud(*model_, TruePose(), name, told_m, truth_m, 0.1, random_));
      back_.clouds.push_back(SeeCloud(*model_, BackPose(), name, told_m, truth_m, 0.1, random_));
    }
    job_.picture = back_.picture = rgbd::PictureOf(kCamera);
    job_.T_robot_camera_start = OffBy(TruePose(), 8.0 * kDegree, 0.02, random_);
    back_.T_robot_camera_start = OffBy(BackPose(), 8.0 * kDegree, 0.02, random_);
  }

  std::unique_ptr<robot::RobotModel> model_ = Build(QuickFourLegRobot());
  std::mt19937_64 random_{20261130};
  LiveJob job_;
  FurtherCameraJob back_;
};

TEST_F(LiveClouds, FindBothPosesAndTheActuatorsOfOneRobot) {
  const double modulus_Pa = model_->body().materials[0].youngs_modulus_Pa;
  job_.further = {back_};
  const LiveResult result = CalibrateLive(*model_, job_);
  ASSERT_TRUE(result.status.ok()) << result.status.message();
  EXPECT_TRUE(result.left_out.empty()) << result.left_out.front();
  ASSERT_TRUE(result.file.pose);
  ExpectPose(ToRigid(result.file.pose->T_robot_camera), TruePose(), 0.5 * kDegree, 1.5e-3);
  ASSERT_EQ(result.file.cameras.size(), 1u);
  const robot::CalibratedCamera& found = result.file.cameras[0];
  EXPECT_EQ(found.name, "back");
  ExpectPose(ToRigid(found.pose.T_robot_camera), BackPose(), 0.5 * kDegree, 1.5e-3);
  EXPECT_GT(found.pose.translation_error_m.minCoeff(), 0.0);
  EXPECT_LE((found.pose.T_robot_camera.translation() - BackPose().translation_m()).norm(),
            4.0 * found.pose.translation_error_m.norm());
  ASSERT_TRUE(found.depth_bias);
  EXPECT_EQ(found.depth_bias->picture, *back_.picture);
  ASSERT_EQ(result.file.drives.size(), 4u);
  for (const robot::CalibratedDrive& drive : result.file.drives) {
    EXPECT_NEAR(drive.drive.offset_m, kZeroOffset_m, 0.4e-3) << drive.cable;
  }
  EXPECT_EQ(model_->body().materials[0].youngs_modulus_Pa, modulus_Pa);
  EXPECT_EQ(model_->drives().at(0).offset_m, 0.0);
}

TEST_F(LiveClouds, OfBothCamerasTellTheActuatorsBetterThanThoseOfOne) {
  const LiveResult one = CalibrateLive(*model_, job_);
  job_.further = {back_};
  const LiveResult both = CalibrateLive(*model_, job_);
  ASSERT_TRUE(one.status.ok() && both.status.ok());
  ASSERT_EQ(one.file.drives.size(), both.file.drives.size());
  for (std::size_t d = 0; d < one.file.drives.size(); ++d) {
    EXPECT_LT(both.file.drives[d].standard_error.offset_m,
              0.95 * one.file.drives[d].standard_error.offset_m);
  }
}

TEST_F(LiveClouds, ACameraThatCannotBeFittedKeepsItsPoseAndIsNamed) {
  for (CloudFrame& frame : back_.clouds) frame.cloud.points_m.array() += 1.0f;
  FurtherCameraJob blind = back_;
  blind.name = "top";
  blind.clouds.clear();
  job_.further = {back_, blind};
  job_.before = robot::DescribeForCalibration(*model_);
  job_.before->cameras.resize(1);
  job_.before->cameras[0].name = "back";
  job_.before->cameras[0].pose.T_robot_camera.translation().x() = 7.0;
  const LiveResult result = CalibrateLive(*model_, job_);
  ASSERT_TRUE(result.status.ok()) << result.status.message();
  EXPECT_THAT(result.left_out,
              ElementsAre(HasSubstr("camera 'back': "), "camera 'top': it did not see the robot"));
  ASSERT_EQ(result.file.cameras.size(), 1u);
  EXPECT_EQ(result.file.cameras[0].pose.T_robot_camera.translation().x(), 7.0);
}

TEST(RequestAfter, HasTheStandardErrorsOfTheCalibrationAsPriors) {
  robot::CalibrationFile file;
  EXPECT_FALSE(RequestAfter(file).actuator_offsets);
  EXPECT_EQ(RequestAfter(file).pressure_zero_sigma_Pa, 0.0);
  EXPECT_EQ(RequestAfter(file).pressure_gain_sigma, 0.0);
  file.drives = {{"a", {1e-3, 0.0}, {2e-4, 0.0}}, {"b", {1e-3, 0.0}, {3e-4, 0.0}}};
  file.pressure_sensors = {
      {.chamber = "c", .zero_Pa = robot::CalibratedNumber{-100.0, 3.0}, .gain = {}}};
  EXPECT_TRUE(RequestAfter(file).actuator_offsets);
  EXPECT_EQ(RequestAfter(file).actuator_offset_sigma_m, 3e-4);
  EXPECT_EQ(RequestAfter(file).pressure_zero_sigma_Pa, 3.0);
  EXPECT_EQ(RequestAfter(file).pressure_gain_sigma, 0.0);
}

TEST(EarlierCalibration, KeepsFurtherCamerasThatWereNotFoundAgain) {
  robot::CalibrationFile before, found;
  before.cameras.resize(2);
  before.cameras[0].name = "back";
  before.cameras[1].name = "top";
  before.cameras[1].pose.T_robot_camera.translation().x() = 1.0;
  found.cameras.resize(1);
  found.cameras[0].name = "back";
  found.cameras[0].pose.T_robot_camera.translation().x() = 2.0;
  KeepCamerasFromBefore(before, &found);
  ASSERT_EQ(found.cameras.size(), 2u);
  EXPECT_EQ(found.cameras[0].pose.T_robot_camera.translation().x(), 2.0);
  EXPECT_EQ(found.cameras[1].name, "top");
}

}  // namespace
}  // namespace palpate::calibration
