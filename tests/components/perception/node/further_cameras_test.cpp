// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <chrono>
#include <cstdlib>
#include <optional>

#include "components/perception/joint_perception.hpp"
#include "libs/core/clock.hpp"
#include "libs/core/error.hpp"
#include "libs/core/index.hpp"
#include "libs/dds/clock_offsets.hpp"
#include "tests/components/perception/markers/marked_scene.hpp"
#include "tests/components/perception/node/node_fixture.hpp"

/// Two depth cameras, from rendered images to one cloud.
namespace palpate::perception {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

constexpr std::int64_t kFrame_ns = 33'000'000;
constexpr std::int64_t kLag_ns = 12'000'000;

scenario::Scenario SeenFrom(double azimuth_deg) {
  scenario::Scenario scenario = MarkedScenario();
  PlaceCamera(0.45, azimuth_deg, 35.0, &scenario);
  return scenario;
}

class FurtherCameraNodeTest : public PerceptionNodeTest {
 protected:
  /// `back_host`: participant of the second camera; nullptr: that of the first.
  explicit FurtherCameraNodeTest(dds::Participant* back_host = nullptr)
      : back_(back_host != nullptr ? *back_host : test_.participant, test_.Waker(), "back"),
        back_reports_(test_.participant.CreateReader(dds::kFurtherPerceptionReportTopic,
                                                     test_.Waker(), "back")),
        poses_{front_scene_.scenario().camera->T_robot_camera,
               back_scene_.scenario().camera->T_robot_camera} {
    test_.loop.Attach(robots_, [this] {
      for (const auto& message : robots_.Take()) {
        cloud_ns_ = dds::StampNs(message.header.stamp);
        EXPECT_EQ(dds::Text(message.header.frame_id), "camera_depth_optical_frame");
        EXPECT_TRUE(dds::FromJoinedPointCloud2(message, &cloud_).ok());
      }
    });
    test_.loop.Attach(back_reports_, [this] {
      for (const auto& message : back_reports_.Take()) {
        back_ns_ = dds::StampNs(message.header.stamp);
        back_status_ = dds::Text(message.status);
        back_points_ = message.robot_points;
        EXPECT_TRUE(dds::FromPose(message.camera_in_first, &T_first_back_));
        EXPECT_EQ(dds::Text(message.header.frame_id), "camera_back_depth_optical_frame");
      }
    });
  }

  std::unique_ptr<PerceptionNode> MakeNode(const NodeConfig& config,
                                           std::optional<Eigen::Isometry3d> first,
                                           std::optional<Eigen::Isometry3d> second) {
    return std::make_unique<PerceptionNode>(
        config, std::move(first), MakeFramePerception, static_cast<int>(dds::TestDomain()),
        ManyImages(), dds::NodeLog::ProcessLog(),
        std::vector<dds::FurtherCamera>{{"back", std::move(second)}});
  }

  /// The robot is of one known colour: there is no prediction.
  static void SetColor(Config* config) { config->robot_color_rgb = {0.85, 0.30, 0.25}; }

  void Start(double camera_wait_s = 0.2) {
    config_ = TestConfig();
    config_.camera_wait_s = camera_wait_s;
    SetColor(&config_);
    node_ = MakeNode(config_, poses_[0], poses_[1]);
    thread_ = std::thread([this] { node_->Run(); });
    ASSERT_TRUE(test_.WaitFor([this] {
      return camera_.is_read() && back_.is_read() && reports_.matched() == 1 &&
             back_reports_.matched() == 1 && robots_.matched() == 1;
    }));
    SendCamera(CameraOf(front_scene_), 1, 1);
    ASSERT_TRUE(back_.PublishCamera(CameraOf(back_scene_), {"Palpate-2", "model", 1, 0.0}, 1));
    ASSERT_TRUE(back_.WaitUntilReceived(std::chrono::seconds(5)));
  }

  static const rgbd::RgbdCamera& CameraOf(const MarkedScene& scene) {
    return scene.scenario().camera->camera;
  }

  void SendFront(std::int64_t stamp_ns) {
    SendFrame(stamp_ns, front_scene_.Take(front_scene_.Rest()), CameraOf(front_scene_));
  }
  void SendBack(std::int64_t stamp_ns) {
    dds::Message<idl::palpate_msgs::FrameInfo> info;
    dds::SetHeader(info->header, stamp_ns, back_.depth_frame());
    info->epoch = 1;
    const rgbd::RgbdFrame& images = back_scene_.Take(back_scene_.Rest());
    ASSERT_TRUE(back_.PublishFrame(CameraOf(back_scene_), images, stamp_ns, *info));
  }
  bool WaitForAll(std::int64_t stamp_ns) {
    return WaitForAnswer(stamp_ns) &&
           test_.WaitFor([&] { return cloud_ns_ == stamp_ns && back_ns_ == stamp_ns; });
  }

  MarkedScene front_scene_{FourLegSurface(), SeenFrom(-30.0)};
  MarkedScene back_scene_{FourLegSurface(), SeenFrom(150.0), 2};
  dds::CameraPublisher back_;
  dds::Reader<idl::palpate_msgs::PerceptionReport> back_reports_;
  std::vector<Eigen::Isometry3d> poses_;
  NodeConfig config_;
  dds::JoinedCloud cloud_;
  std::int64_t cloud_ns_ = 0, back_ns_ = 0;
  std::string back_status_;
  std::uint32_t back_points_ = 0;
  Eigen::Isometry3d T_first_back_ = Eigen::Isometry3d::Identity();
};

TEST_F(FurtherCameraNodeTest, OneCloudHoldsWhatBothCamerasSeeAsOffline) {
  MarkedScene front_again(FourLegSurface(), SeenFrom(-30.0));
  MarkedScene back_again(FourLegSurface(), SeenFrom(150.0), 2);
  rgbd::RgbdFrame front = front_again.Take(front_again.Rest());
  rgbd::RgbdFrame back = back_again.Take(back_again.Rest());
  front.stamp_ns = back.stamp_ns = kFrame_ns;
  Config config;
  SetColor(&config);
  JointPerception perception{config};
  perception.Open({CameraOf(front_scene_), CameraOf(back_scene_)});
  const JointObservation& expected =
      perception.Update(kFrame_ns, {{.images = &front, .T_robot_camera = poses_[0]},
                                    {.images = &back, .T_robot_camera = poses_[1]}});
  ASSERT_TRUE(expected.views[0].frame.status.ok()) << expected.views[0].frame.status.message();
  ASSERT_TRUE(expected.views[1].frame.status.ok()) << expected.views[1].frame.status.message();

  Start();
  SendBack(kFrame_ns + kLag_ns);
  SendFront(kFrame_ns);
  ASSERT_TRUE(WaitForAll(kFrame_ns));
  EXPECT_EQ(answers_.back().status, "ok");
  EXPECT_EQ(back_status_, "ok");
  std::size_t next = 0;
  for (std::size_t k = 0; k < 2; ++k) {
    const rgbd::SensedCloud& seen = expected.views[k].frame.robot;
    ASSERT_GT(seen.Count(), 100);
    ASSERT_LE(next + At(seen.Count()), cloud_.cameras.size());
    const Eigen::Isometry3d T_camera_first = poses_[k].inverse() * poses_[0];
    for (Eigen::Index i = 0; i < seen.Count(); ++i, ++next) {
      ASSERT_EQ(cloud_.cameras[next], k);
      const Eigen::Vector3d point_m =
          T_camera_first * cloud_.points.points_m.col(ToIndex(next)).cast<double>();
      ASSERT_LT((point_m - seen.points_m.col(i).cast<double>()).norm(), 2e-7);
      ASSERT_EQ(cloud_.points.sigma_m[ToIndex(next)], seen.sigma_m[i]);
    }
  }
  EXPECT_EQ(next, cloud_.cameras.size());
  EXPECT_EQ(back_points_, expected.views[1].frame.robot.Count());
}

TEST_F(FurtherCameraNodeTest, WithoutTheSecondTheFrameGoesOnAndTheReportSaysSo) {
  Start();
  SendFront(kFrame_ns);
  ASSERT_TRUE(WaitForAll(kFrame_ns));
  EXPECT_EQ(answers_.back().status, "ok");
  EXPECT_THAT(answers_.back().notes, Contains("camera 'back': no image of this time"));
  EXPECT_EQ(back_status_, "stale");
  EXPECT_EQ(back_points_, 0u);
  EXPECT_GT(cloud_.points.Count(), 100);
  EXPECT_THAT(cloud_.cameras, ::testing::Each(0u));
  // It comes back.
  SendBack(2 * kFrame_ns);
  SendFront(2 * kFrame_ns);
  ASSERT_TRUE(WaitForAll(2 * kFrame_ns));
  EXPECT_EQ(back_status_, "ok");
  EXPECT_THAT(cloud_.cameras, Contains(1u));
  EXPECT_THAT(answers_.back().notes, ::testing::Not(Contains(HasSubstr("back"))));
}

TEST_F(FurtherCameraNodeTest, WithoutTheFirstTheFrameGoesOnToo) {
  Start();
  SendBack(kFrame_ns);
  ASSERT_TRUE(WaitForAll(kFrame_ns));
  EXPECT_EQ(answers_.back().status, "ok");
  EXPECT_THAT(answers_.back().notes, Contains("the first camera: no image of this time"));
  EXPECT_GT(cloud_.points.Count(), 100);
  EXPECT_THAT(cloud_.cameras, ::testing::Each(1u));
}

/// A calibration that has both cameras moves both; one that lacks the second moves none.
TEST_F(FurtherCameraNodeTest, TakesThePosesOfACalibrationOfAllCameras) {
  auto calibrations = test_.participant.CreateWriter(dds::kCalibrationTopic, test_.Waker());
  Start();
  ASSERT_TRUE(test_.WaitFor([&] { return calibrations.matched() == 1; }));
  SendMesh();
  const Eigen::Isometry3d nearer(Eigen::Translation3d(0.0, 0.0, -1e-3));
  const auto send = [&](const std::string& date_utc, const std::vector<std::string>& names) {
    dds::Message<idl::palpate_msgs::Calibration> message;
    dds::SetText(message->mesh_hash, "hash");
    dds::SetText(message->date_utc, date_utc);
    message->has_camera = true;
    message->camera_in_robot = dds::ToPose(poses_[0]);
    dds::Resize(message->cameras, names.size());
    for (std::size_t k = 0; k < names.size(); ++k) {
      dds::SetText(message->cameras._buffer[k].name, names[k]);
      message->cameras._buffer[k].camera_in_robot = dds::ToPose(poses_[1] * nearer);
    }
    ASSERT_TRUE(calibrations.Write(message));
    ASSERT_TRUE(calibrations.WaitUntilReceived(std::chrono::seconds(5)));
  };
  std::int64_t stamp_ns = 0;
  const auto ask = [&] {
    stamp_ns += kFrame_ns;
    SendBack(stamp_ns);
    SendFront(stamp_ns);
    ASSERT_TRUE(WaitForAll(stamp_ns));
  };
  const Eigen::Isometry3d before = poses_[0].inverse() * poses_[1];
  send("2026-01-31T12:00:00Z", {});
  ask();
  EXPECT_TRUE(T_first_back_.isApprox(before, 1e-12));
  send("2026-01-31T13:00:00Z", {"back", "top"});
  // Readers do not wait for each other: ask until the node has it.
  for (int k = 0; k < 100 && T_first_back_.isApprox(before, 1e-12); ++k) ask();
  EXPECT_TRUE(T_first_back_.isApprox(before * nearer, 1e-12));
  EXPECT_EQ(back_status_, "ok");
  EXPECT_THAT(answers_.back().notes,
              Contains("/calibration: it has camera 'top', not in the setting 'cameras'"));
}

/// The host of the second camera.
struct OtherHost {
  OtherHost() {
    setenv("PALPATE_HOST", "lab2", 1);
    there.emplace("capture_back", PerceptionNodeTestTable());
    unsetenv("PALPATE_HOST");
  }
  static dds::TopicTable PerceptionNodeTestTable() {
    return dds::TableWith("/camera_<name>/depth/image_raw",
                          [](dds::TopicSettings& topic) { topic.depth = 32; });
  }
  std::optional<dds::TestNode> there;
};

class CamerasOfTwoHosts : private OtherHost, public FurtherCameraNodeTest {
 protected:
  CamerasOfTwoHosts() : FurtherCameraNodeTest(&there->participant) {}
  static constexpr std::int64_t kAhead_ns = 2'500'000'000;

  dds::ClockOffsets clocks_{there->participant, dds::Host{"lab2", "lab2"},
                            [] { return WallNow_ns() + kAhead_ns; }};
};

/// The second camera's host is 2.5 s ahead. Frames wait until that is measured, then those of one
/// instant are joined.
TEST_F(CamerasOfTwoHosts, FramesAreJoinedByTheClockOfTheFirst) {
  constexpr std::int64_t kApart_ns = 100'000'000;
  Start(1.0);
  std::int64_t stamp_ns = 0;
  const auto ask = [&] {
    stamp_ns += kApart_ns;
    // In this order the frame has this stamp, even where the second image comes too late.
    SendFront(stamp_ns);
    SendBack(stamp_ns + kAhead_ns);
    return WaitForAll(stamp_ns);
  };
  ASSERT_TRUE(ask());
  EXPECT_EQ(answers_.back().status, "stale");
  EXPECT_EQ(answers_.back().reason, "the clock of host 'lab2' is being measured");
  EXPECT_EQ(cloud_.points.Count(), 0);
  test_.loop.Every(std::chrono::milliseconds(20), [this] { clocks_.Send({}); });
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (back_status_ != "ok" && std::chrono::steady_clock::now() < deadline) {
    ASSERT_TRUE(ask()) << "the last answer is of " << answers_.back().stamp_ns << " in place of "
                       << stamp_ns << ": " << answers_.back().reason;
  }
  EXPECT_EQ(back_status_, "ok") << testing::PrintToString(answers_.back().notes);
  EXPECT_EQ(answers_.back().status, "ok");
  EXPECT_THAT(cloud_.cameras, Contains(0u));
  EXPECT_THAT(cloud_.cameras, Contains(1u));
}

/// A frame that none of the cameras can be used in is answered, too.
TEST_F(FurtherCameraNodeTest, ImagesOfAnotherSizeInBothAreAnswered) {
  Start();
  SendFrame(kFrame_ns, Images(), CameraOf(front_scene_));
  ASSERT_TRUE(WaitForAll(kFrame_ns));
  EXPECT_EQ(answers_.back().status, "invalid_input");
  EXPECT_EQ(back_status_, "stale");
  EXPECT_EQ(cloud_.points.Count(), 0);
}

TEST(JointReport, KeepsTheNotesOfTheFirstCameraBesideThoseOfMissingOnes) {
  FrameOutcome outcome;
  outcome.cameras.resize(2);
  outcome.cameras[1].name = "back";
  outcome.cameras[1].status = {StatusCode::kStale, "no image of this time"};
  outcome.observation.views.resize(2);
  outcome.observation.views[0].frame.status = Status::Ok();
  outcome.observation.views[0].frame.notes = {"the light has changed"};
  outcome.observation.views[1].frame.status = outcome.cameras[1].status;
  const auto report = ToReport(outcome);
  EXPECT_EQ(dds::Text(report->status), "ok");
  ASSERT_EQ(report->notes._length, 2u);
  EXPECT_EQ(dds::Text(report->notes._buffer[0]), "the light has changed");
  EXPECT_EQ(dds::Text(report->notes._buffer[1]), "camera 'back': no image of this time");
  const auto back = ToReportOf(outcome, 1, "camera_back_depth_optical_frame");
  EXPECT_EQ(dds::Text(back->status), "stale");
  EXPECT_EQ(back->notes._length, 0u);
}

TEST_F(FurtherCameraNodeTest, PosesOfAllCamerasAreRequired) {
  NodeConfig config = TestConfig();
  EXPECT_THROW(MakeNode(config, std::nullopt, poses_[1]), InputError);
  EXPECT_THROW(MakeNode(config, poses_[0], std::nullopt), InputError);
}

}  // namespace
}  // namespace palpate::perception
