// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>

#include "libs/dds/camera_topics.hpp"
#include "libs/dds/cloud_messages.hpp"
#include "tests/components/calibration/node/node_fixture.hpp"

/// palpate-calibration with a camera beside the first.
namespace palpate::calibration {
namespace {

using ::testing::HasSubstr;
constexpr auto kFrontPose = "{translation_m: [0, 0, 0.5], rotation_xyzw: [1, 0, 0, 0]}";

class FurtherCameraCalibration : public CalibrationNodeTest {
 protected:
  FurtherCameraCalibration()
      : joined_(test_.participant.CreateWriter(dds::kRobotCloudTopic, test_.Waker())),
        back_(test_.participant.CreateWriter(dds::kFurtherPerceptionReportTopic, test_.Waker(),
                                             "back")) {}

  void Start(std::optional<Eigen::Isometry3d> T_robot_back) {
    NodeConfig config = TestConfig();
    config.source = "clouds";
    config.camera_pose = kFrontPose;
    StartNode(config, fit_.Fit(), {{"back", std::move(T_robot_back)}});
    ASSERT_TRUE(test_.WaitFor([this] { return joined_.matched() == 1 && back_.matched() == 1; }));
  }

  /// A point of each of these cameras.
  void SendJoined(std::int64_t stamp_ns, std::vector<std::uint32_t> cameras) {
    dds::JoinedCloud cloud;
    const auto count = static_cast<Eigen::Index>(cameras.size());
    cloud.points.points_m = Eigen::Matrix3Xf::Constant(3, count, 0.25f);
    cloud.points.sigma_m = Eigen::VectorXf::Ones(count);
    cloud.points.colors_rgb.assign(3 * cameras.size(), 9);
    cloud.cameras = std::move(cameras);
    ASSERT_TRUE(joined_.Write(dds::ToJoinedPointCloud2(cloud, stamp_ns, kCameraFrame)));
    perception_.SendReport({.stamp_ns = stamp_ns});
  }
  void SendBackReport(std::int64_t stamp_ns, const std::string& status = "ok") {
    dds::Message<idl::palpate_msgs::PerceptionReport> report;
    dds::SetHeader(report->header, stamp_ns, "camera_back_depth_optical_frame");
    dds::SetText(report->status, status);
    dds::SetPicture(report->picture, {640, 480, 425.0, 425.0, 319.5, 239.5});
    report->camera_in_first = dds::ToPose(Eigen::Isometry3d(Eigen::Translation3d(0.0, 0.0, -1.0)));
    ASSERT_TRUE(back_.Write(report));
  }

  dds::Writer<idl::sensor_msgs::PointCloud2> joined_;
  dds::Writer<idl::palpate_msgs::PerceptionReport> back_;
};

TEST_F(FurtherCameraCalibration, TakesTheCloudOfEachInItsOwnFrame) {
  Start(Eigen::Isometry3d(Eigen::Translation3d(0.0, 0.0, 2.0)));
  Ask({.frames = 2});
  WaitForState("one", "collecting");
  SendRest(1 * kSecond_ns, 1e-3);
  SendBackReport(1 * kSecond_ns);
  SendJoined(1 * kSecond_ns, {0, 1, 1});
  EXPECT_EQ(WaitForState("one", "collecting").taken, 1u);
  SendRest(2 * kSecond_ns, 3e-3);
  SendBackReport(2 * kSecond_ns, "stale");
  SendJoined(2 * kSecond_ns, {0, 0});
  WaitForState("one", "done");
  const LiveJob job = fit_.jobs().at(0);
  ASSERT_EQ(job.clouds.size(), 2u);
  EXPECT_EQ(job.clouds[0].cloud.Count(), 1);
  EXPECT_EQ(job.clouds[1].cloud.Count(), 2);
  ASSERT_EQ(job.further.size(), 1u);
  const FurtherCameraJob& back = job.further[0];
  EXPECT_EQ(back.name, "back");
  ASSERT_EQ(back.clouds.size(), 1u) << "it did not see the second setting";
  ASSERT_EQ(back.clouds[0].cloud.Count(), 2);
  EXPECT_EQ(back.clouds[0].cloud.points_m(2, 0), 1.25f);
  EXPECT_NEAR(back.clouds[0].cables.at(0).value, 1e-3, 1e-15);
  ASSERT_TRUE(back.picture);
  EXPECT_EQ(back.picture->width_px, 640);
  EXPECT_EQ(back.T_robot_camera_start.translation_m().z(), 2.0);
}

TEST_F(FurtherCameraCalibration, NeedsAnApproximatePose) {
  Start(std::nullopt);
  Ask({.source = "clouds"});
  const Told told = WaitForState("one", "refused");
  EXPECT_EQ(told.status, "no_calibration");
  EXPECT_THAT(told.reason, HasSubstr("pose of camera 'back'"));
}

TEST_F(FurtherCameraCalibration, StartsFromThePosesOfTheLastCalibration) {
  robot::CalibrationFile before = robot::DescribeForCalibration(*robot_);
  before.date_utc = before.data = before.data_hash = "2026-01-30T12:00:00Z";
  before.pose.emplace();
  before.cameras.resize(1);
  before.cameras[0].name = "back";
  before.cameras[0].pose.T_robot_camera.translation().z() = 3.0;
  robot::WriteCalibrationFile(before, folder_.path() / "calibration.yaml");
  Start(std::nullopt);
  ASSERT_TRUE(test_.WaitFor([&] { return !found_.empty(); }));
  ASSERT_EQ(found_.back().cameras.size(), 1u) << "the file is published";
  Ask({.id = "two", .source = "clouds", .frames = 1});
  WaitForState("two", "collecting");
  SendRest(1 * kSecond_ns, 1e-3);
  SendBackReport(1 * kSecond_ns);
  SendJoined(1 * kSecond_ns, {0, 1});
  WaitForState("two", "done");
  EXPECT_EQ(fit_.jobs().at(0).further.at(0).T_robot_camera_start.translation_m().z(), 3.0);
}

}  // namespace
}  // namespace palpate::calibration
