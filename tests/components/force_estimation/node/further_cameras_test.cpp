// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>

#include <memory>
#include <string>
#include <vector>

#include "libs/core/error.hpp"
#include "libs/dds/camera_topics.hpp"
#include "libs/dds/geometry_messages.hpp"
#include "libs/geometry/pose_text.hpp"
#include "tests/components/force_estimation/node/shape_node_fixture.hpp"

/// palpate-force-estimation from the clouds of two cameras.
namespace palpate::force_estimation {
namespace {

using ::testing::HasSubstr;

Eigen::Isometry3d BackPose() {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translate(Eigen::Vector3d(0.1, -0.2, 0.6));
  pose.rotate(Eigen::AngleAxisd(2.5, Eigen::Vector3d(1.0, 2.0, -0.5).normalized()));
  return pose;
}

class FurtherCameraShapeTest : public ShapeNodeTest {
 protected:
  FurtherCameraShapeTest()
      : ShapeNodeTest(TestConfig(), {{"back", BackPose()}}),
        joined_(test_.participant.CreateWriter(dds::kRobotCloudTopic, test_.Waker())),
        back_(test_.participant.CreateWriter(dds::kFurtherPerceptionReportTopic, test_.Waker(),
                                             "back")) {
    EXPECT_TRUE(test_.WaitFor([this] { return joined_.matched() == 1 && back_.matched() == 1; }));
  }

  static Eigen::Isometry3d FrontPose() {
    Eigen::Isometry3d pose(Eigen::Translation3d(0.0, 0.0, 0.5));
    pose.rotate(Eigen::Quaterniond(0.0, 1.0, 0.0, 0.0));
    return pose;
  }

  /// A point of each of these cameras, in the frame of the first.
  void SendJoined(std::int64_t stamp_ns, std::vector<std::uint32_t> cameras) {
    dds::JoinedCloud cloud;
    const auto count = static_cast<Eigen::Index>(cameras.size());
    cloud.points.points_m.resize(3, count);
    for (Eigen::Index i = 0; i < count; ++i) {
      cloud.points.points_m.col(i) =
          PointOf(i) + Eigen::Vector3f::Constant(1e-9f * static_cast<float>(stamp_ns));
    }
    cloud.points.sigma_m = Eigen::VectorXf::LinSpaced(count, 1e-3f, 2e-3f);
    cloud.points.colors_rgb.assign(3 * cameras.size(), 9);
    cloud.cameras = std::move(cameras);
    ASSERT_TRUE(joined_.Write(
        dds::ToJoinedPointCloud2(cloud, stamp_ns, test_support::PerceptionSender::kFrame)));
  }
  static Eigen::Vector3f PointOf(Eigen::Index i) {
    return {0.1f, 0.2f, 0.3f + 0.1f * static_cast<float>(i)};
  }

  void SendBackReport(std::int64_t stamp_ns, const std::string& status = "ok") {
    dds::Message<idl::palpate_msgs::PerceptionReport> report;
    dds::SetHeader(report->header, stamp_ns, "camera_back_depth_optical_frame");
    dds::SetText(report->status, status);
    report->camera_in_first = dds::ToPose(T_first_back_);
    dds::Resize(report->texture, 1);
    report->texture._buffer[0].id = 42;
    report->texture._buffer[0].direction[2] = 1.0f;
    report->texture._buffer[0].sigma_rad = 1e-3f;
    ASSERT_TRUE(back_.Write(report));
  }

  /// All but the report of the second camera.
  void SendRest(std::int64_t stamp_ns, std::vector<std::uint32_t> cameras) {
    SendCable(stamp_ns);
    SendJoined(stamp_ns, std::move(cameras));
    perception_.SendReport({.stamp_ns = stamp_ns});
    perception_.SendContacts({.stamp_ns = stamp_ns});
  }
  Answer AskBoth(std::int64_t stamp_ns, std::vector<std::uint32_t> cameras,
                 const std::string& back_status = "ok") {
    SendBackReport(stamp_ns, back_status);
    SendRest(stamp_ns, std::move(cameras));
    EXPECT_TRUE(
        test_.WaitFor([&] { return !answers_.empty() && answers_.back().stamp_ns == stamp_ns; }));
    return answers_.empty() ? Answer() : answers_.back();
  }

  dds::Writer<idl::sensor_msgs::PointCloud2> joined_;
  dds::Writer<idl::palpate_msgs::PerceptionReport> back_;
  Eigen::Isometry3d T_first_back_ = FrontPose().inverse() * BackPose();  ///< as perception has it
};

TEST_F(FurtherCameraShapeTest, EachViewHasItsOwnPointsPoseAndTexture) {
  EXPECT_EQ(AskBoth(1'000, {0, 1, 0}).status, "ok");
  const ShapeFrame frame = script_.calls().at(0).shape.frame;
  ASSERT_EQ(frame.views.size(), 2u);
  ASSERT_EQ(frame.views[0].cloud.Count(), 2);
  EXPECT_NEAR(frame.views[0].cloud.points_m(2, 1), 0.5f, 1e-5f);
  EXPECT_TRUE(frame.views[0].T_robot_camera.isApprox(FrontPose(), 1e-12));
  const ShapeView& back = frame.views[1];
  ASSERT_EQ(back.cloud.Count(), 1);
  const Eigen::Vector3d seen_m = back.cloud.points_m.col(0).cast<double>();
  const Eigen::Vector3d in_robot_m = FrontPose() * PointOf(1).cast<double>();
  EXPECT_LT((BackPose() * seen_m - in_robot_m).norm(), 1e-5);
  EXPECT_FLOAT_EQ(back.cloud.sigma_m[0], 1.5e-3f);
  EXPECT_TRUE(back.T_robot_camera.isApprox(BackPose(), 1e-12));
  ASSERT_EQ(back.texture.ids.size(), 1u);
  EXPECT_EQ(back.texture.ids[0], 42u);
  EXPECT_TRUE(frame.views[0].texture.ids.empty());
  // Contacts are in the frame of the first.
  ASSERT_EQ(frame.contacts.size(), 1u);
  EXPECT_TRUE(frame.contacts[0].position_m.isApprox(Eigen::Vector3d(0.1, -0.2, 0.2), 1e-12));
}

/// A calibration reaches perception and this process at two times.
TEST_F(FurtherCameraShapeTest, PointsAreSortedByThePosesThatJoinedThem) {
  T_first_back_ = Eigen::Translation3d(0.0, 0.0, 0.25);
  EXPECT_EQ(AskBoth(1'000, {0, 1}).status, "ok");
  const ShapeFrame frame = script_.calls().at(0).shape.frame;
  ASSERT_EQ(frame.views[1].cloud.Count(), 1);
  EXPECT_NEAR(frame.views[1].cloud.points_m(2, 0), PointOf(1).z() - 0.25f, 1e-5f);
  EXPECT_TRUE(frame.views[1].T_robot_camera.isApprox(BackPose(), 1e-12));
}

TEST_F(FurtherCameraShapeTest, ACalibrationMovesAllCamerasOrNone) {
  auto calibrations = test_.participant.CreateWriter(dds::kCalibrationTopic, test_.Waker());
  ASSERT_TRUE(test_.WaitFor([&] { return calibrations.matched() == 1; }));
  const Eigen::Isometry3d front(Eigen::Translation3d(0.0, 0.0, 0.75));
  const Eigen::Isometry3d back(Eigen::Translation3d(0.0, 0.0, 1.25));
  const robot::CalibrationFile present = robot::DescribeForCalibration(*NodeTestRobot());
  const auto send = [&](const std::string& date_utc, const std::vector<std::string>& names) {
    dds::Message<idl::palpate_msgs::Calibration> message;
    dds::SetText(message->robot, present.robot);
    dds::SetText(message->mesh_hash, present.mesh_hash);
    dds::SetText(message->element, present.element);
    dds::SetText(message->material_model, present.model);
    dds::SetText(message->volumetric, present.volumetric);
    message->poissons_ratio = present.poissons_ratio;
    dds::SetText(message->date_utc, date_utc);
    message->has_camera = true;
    message->camera_in_robot = dds::ToPose(front);
    dds::Resize(message->cameras, names.size());
    for (std::size_t k = 0; k < names.size(); ++k) {
      dds::SetText(message->cameras._buffer[k].name, names[k]);
      message->cameras._buffer[k].camera_in_robot = dds::ToPose(back);
    }
    dds::Resize(message->moduli, 1);
    dds::SetText(message->moduli._buffer[0].part, "body");
    message->moduli._buffer[0].youngs_modulus_pa = names.empty() ? 321e3 : 654e3;
    ASSERT_TRUE(calibrations.Write(message));
    ASSERT_TRUE(calibrations.WaitUntilReceived(std::chrono::seconds(5)));
  };
  std::int64_t stamp_ns = 0;
  /// Readers do not wait for each other: asks until the node has the calibration.
  const auto ask_until = [&](double modulus_Pa) {
    for (int k = 0; k < 100; ++k) {
      AskBoth(stamp_ns += 1'000, {0, 1});
      if (script_.calls().back().youngs_modulus_Pa == modulus_Pa) break;
    }
    EXPECT_EQ(script_.calls().back().youngs_modulus_Pa, modulus_Pa);
    return script_.calls().back().shape.frame;
  };
  send("2026-01-31T12:00:00Z", {"top"});
  const ShapeFrame before = ask_until(654e3);
  EXPECT_TRUE(before.views[0].T_robot_camera.isApprox(FrontPose(), 1e-12));
  EXPECT_TRUE(before.views[1].T_robot_camera.isApprox(BackPose(), 1e-12));
  send("2026-01-31T12:30:00Z", {});
  EXPECT_TRUE(ask_until(321e3).views[0].T_robot_camera.isApprox(FrontPose(), 1e-12));
  send("2026-01-31T13:00:00Z", {"back"});
  const ShapeFrame after = ask_until(654e3);
  EXPECT_TRUE(after.views[0].T_robot_camera.isApprox(front, 1e-12));
  EXPECT_TRUE(after.views[1].T_robot_camera.isApprox(back, 1e-12));
}

TEST_F(FurtherCameraShapeTest, ACameraThatIsMissingHasAnEmptyView) {
  EXPECT_EQ(AskBoth(1'000, {0, 0}, "stale").status, "ok");
  const ShapeFrame frame = script_.calls().at(0).shape.frame;
  ASSERT_EQ(frame.views.size(), 2u);
  EXPECT_EQ(frame.views[0].cloud.Count(), 2);
  EXPECT_EQ(frame.views[1].cloud.Count(), 0);
  EXPECT_TRUE(frame.views[1].T_robot_camera.isApprox(BackPose(), 1e-12));
}

TEST_F(FurtherCameraShapeTest, AFrameWaitsForTheReportOfEachCamera) {
  SendRest(1'000, {0, 1});
  EXPECT_EQ(AskBoth(2'000, {0, 1}).status, "ok");
  EXPECT_EQ(answers_.size(), 1u) << "the first frame lost a part";
}

TEST_F(FurtherCameraShapeTest, PointsOfACameraThatIsNotInTheSettingsAreRefused) {
  const Answer answer = AskBoth(1'000, {0, 2});
  EXPECT_EQ(answer.status, "invalid_input");
  EXPECT_THAT(answer.reason, HasSubstr("a point of camera 2"));
  EXPECT_TRUE(script_.calls().empty());
}

TEST(FurtherCameraSettings, PosesAndTheSourceShapeAreRequired) {
  Script script;
  const auto refusal = [&](const NodeConfig& config, const dds::FurtherCamera& camera) {
    try {
      ForceEstimationNode(config, NodeTestRobot(), {}, static_cast<int>(dds::TestDomain()),
                          dds::BuiltInTable(), {}, script.Maker(), {camera});
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  NodeConfig config = TestConfig();
  EXPECT_EQ(refusal(config, {"back", BackPose()}), "accepted");
  EXPECT_THAT(refusal(config, {"back", std::nullopt}), HasSubstr("where is 'back'"));
  config.source = "markers";
  EXPECT_THAT(refusal(config, {"back", BackPose()}), HasSubstr("source shape"));
  config = TestConfig();
  config.source = "shape";
  config.camera_pose.clear();
  EXPECT_THAT(refusal(config, {"back", BackPose()}), HasSubstr("camera_pose"));
}

}  // namespace
}  // namespace palpate::force_estimation
