// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "components/calibration/cloud/cloud_calibration.hpp"
#include "components/calibration/cloud/join_frames.hpp"
#include "components/calibration/joint/found_calibration.hpp"
#include "libs/core/text.hpp"
#include "tests/components/calibration/cloud/cloud_scene.hpp"

/// Clouds of two cameras in one fit.
namespace palpate::calibration {
namespace {

using ::testing::HasSubstr;

constexpr double kOffset_m = 1e-3;

geometry::RigidTransform BackPose() { return LookAt({-0.343, 0.198, 0.275}, {0.0, 0.0, 0.065}); }

class CloudsOfTwoCameras : public ::testing::Test {
 protected:
  CloudsOfTwoCameras() {
    settings_.further_cameras = {
        {.name = "back", .T_robot_camera_start = OffBy(BackPose(), 0.02, 0.004, random_)}};
  }

  /// What the camera at `pose` sees of actuators that count from kOffset_m.
  std::vector<CloudFrame> See(const geometry::RigidTransform& pose,
                              const std::vector<std::vector<double>>& told_m) {
    std::vector<CloudFrame> frames;
    for (const std::vector<double>& pulls_m : told_m) {
      std::vector<double> truth_m = pulls_m;
      for (double& pull_m : truth_m) pull_m += kOffset_m;
      frames.push_back(SeeCloud(*model_, pose, "pull " + FormatNumber(1e3 * pulls_m[0]), pulls_m,
                                truth_m, 0.1, random_));
    }
    return frames;
  }
  CloudCalibration Fit(const std::vector<CloudFrame>& frames) {
    const auto start = OffBy(TruePose(), 0.02, 0.004, random_);
    return CalibrateFromClouds(*model_, frames, start, settings_);
  }

  const std::vector<std::vector<double>> told_m_ = {
      {0.006, 0.004, 0.010, 0.004}, {0.010, 0.004, 0.004, 0.011}, {0.005, 0.012, 0.006, 0.006}};
  std::unique_ptr<robot::RobotModel> model_ = Build(QuickFourLegRobot());
  std::mt19937_64 random_{20261130};
  CloudSettings settings_;
};

/// Each camera adds information on the actuators; the model's surface errors are those of both.
TEST_F(CloudsOfTwoCameras, TellTheActuatorsBetterThanEachAndBothPoses) {
  const std::vector<CloudFrame> front = See(TruePose(), told_m_);
  const std::vector<CloudFrame> back = See(BackPose(), told_m_);
  const CloudCalibration both = Fit(JoinFrames(front, {back}));
  ASSERT_TRUE(both.status.ok()) << both.status.message();
  ExpectPose(both.joint.T_robot_camera, TruePose(), 0.5 * kDegree, 1.5e-3);
  ASSERT_EQ(both.joint.further_cameras.size(), 1u);
  ExpectPose(both.joint.further_cameras[0].T_robot_camera, BackPose(), 0.5 * kDegree, 1.5e-3);
  EXPECT_TRUE(both.joint.depth_bias);
  EXPECT_TRUE(both.joint.further_cameras[0].depth_bias);
  EXPECT_GT(both.joint.further_cameras[0].pose_covariance.diagonal().minCoeff(), 0.0);
  ASSERT_EQ(both.further_matches.size(), 1u);
  EXPECT_GT(both.further_matches[0][2].surface_covered, 0.95);
  settings_.further_cameras.clear();
  const CloudCalibration alone = Fit(front);
  ASSERT_TRUE(alone.status.ok()) << alone.status.message();
  for (const char* cable : {"north", "west", "south", "east"}) {
    SCOPED_TRACE(cable);
    const FittedValue* found = FindValue(both.joint, std::string("cable_offset:") + cable);
    const FittedValue* by_one = FindValue(alone.joint, std::string("cable_offset:") + cable);
    ASSERT_TRUE(found != nullptr && by_one != nullptr && found->determined);
    EXPECT_NEAR(found->value, kOffset_m, 3.0 * found->standard_error);
    EXPECT_LT(found->standard_error, 0.95 * by_one->standard_error);
  }
}

TEST_F(CloudsOfTwoCameras, NeedNotSeeTheRobotInEachFrame) {
  const std::vector<CloudFrame> front = See(TruePose(), {told_m_[0], told_m_[1]});
  const std::vector<CloudFrame> back = See(BackPose(), {told_m_[1], told_m_[2]});
  const std::vector<CloudFrame> joined = JoinFrames(front, {back});
  ASSERT_EQ(joined.size(), 3u);
  EXPECT_EQ(joined[0].further[0].Count(), 0);
  EXPECT_EQ(joined[1].further[0].Count(), back[0].cloud.Count());
  EXPECT_EQ(joined[2].cloud.Count(), 0);
  const CloudCalibration fit = Fit(joined);
  ASSERT_TRUE(fit.status.ok()) << fit.status.message();
  ExpectPose(fit.joint.further_cameras[0].T_robot_camera, BackPose(), 0.5 * kDegree, 1.5e-3);
  EXPECT_EQ(fit.matches[2].points, 0);
  EXPECT_EQ(fit.further_matches[0][0].points, 0);
  EXPECT_TRUE(IsPossible(fit.joint));
}

TEST_F(CloudsOfTwoCameras, AreRefusedWithTheCameraThatIsWrong) {
  const std::vector<CloudFrame> front = See(TruePose(), {told_m_[0]});
  CloudCalibration fit = Fit(JoinFrames(front, {{}}));
  EXPECT_EQ(fit.status.code(), StatusCode::kNoRobotSeen);
  EXPECT_THAT(fit.status.message(), HasSubstr("camera 'back' sees the robot in no frame"));
  std::vector<CloudFrame> two = JoinFrames(front, {front, front});
  EXPECT_THAT(Fit(two).status.message(), HasSubstr("clouds of 2 further cameras"));
  std::vector<CloudFrame> elsewhere = front;
  elsewhere[0].cloud.points_m.array() += 1.0f;
  fit = Fit(JoinFrames(front, {elsewhere}));
  EXPECT_EQ(fit.status.code(), StatusCode::kNotConverged);
  EXPECT_THAT(fit.status.message(), HasSubstr("camera 'back': no pose near the initial one"));
  EXPECT_THAT(Fit(JoinFrames({}, {front})).status.message(),
              HasSubstr("the first camera sees the robot in no frame"));
}

/// What a fit of all leaves must not be more than twice what the first camera's own leaves.
TEST(AgreesWith, ComparesChiSquaredPerDegreeOfFreedom) {
  JointCalibration first, all;
  first.chi_squared = 300.0;
  first.degrees_of_freedom = 1000;
  all.degrees_of_freedom = 2000;
  all.chi_squared = 1190.0;
  EXPECT_TRUE(AgreesWith(first, all));
  all.chi_squared = 1210.0;
  EXPECT_FALSE(AgreesWith(first, all));
}

}  // namespace
}  // namespace palpate::calibration
