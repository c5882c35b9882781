// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "components/perception/node/driver_streams.hpp"
#include "components/perception/node/node.hpp"
#include "libs/core/file.hpp"
#include "libs/dds/driver_topics.hpp"
#include "libs/rgbd/png.hpp"
#include "tests/components/perception/node/driver_fixture.hpp"
#include "tests/components/perception/node/scripted_perception.hpp"
#include "tests/support/test_folder.hpp"

/// palpate-perception with the streams of a camera driver of ROS 2.
namespace palpate::perception {
namespace {

using testing::HasSubstr;

constexpr std::int64_t kMs = 1'000'000;
constexpr std::int64_t kPeriod_ns = 33 * kMs;

NodeConfig DriverConfig() {
  NodeConfig config;
  config.camera.source = "driver";
  config.dds.remap = kRealSenseRules;
  // No frame of a test is late: what waits longer waits for what never comes.
  config.pairing_wait_s = 1.0;
  return config;
}

/// Plays the driver of a camera whose images image_transport packs.
class PackedDriver {
 public:
  PackedDriver()
      : node_("packed_camera"),
        depths_(Packed("/camera/camera/depth/image_rect_raw/compressedDepth")),
        colors_(Packed("/camera/camera/color/image_raw/compressed")),
        info_topics_{Info("/camera/camera/depth/camera_info"),
                     Info("/camera/camera/color/camera_info")} {}

  bool IsRead() const {
    return depths_.matched() == 1 && colors_.matched() == 1 && info_topics_[0].matched() == 1 &&
           info_topics_[1].matched() == 1;
  }
  void Send(std::int64_t stamp_ns, std::uint16_t depth, std::uint8_t color) {
    const test_support::TestFolder folder;
    rgbd::WriteDepthPng(folder / "depth.png",
                        rgbd::DepthImage(kDriverWidth_px, kDriverHeight_px, depth));
    Write(&depths_, stamp_ns, "16UC1; compressedDepth png",
          std::string(12, '\0') + ReadFile(folder / "depth.png"));
    Write(&colors_, stamp_ns, "rgb8; png compressed",
          rgbd::EncodeColorPng(rgbd::ColorImage(kDriverWidth_px, kDriverHeight_px, color), 1));
    for (auto& infos : info_topics_) {
      EXPECT_TRUE(infos.Write(DriverInfo(5.0, stamp_ns, FakeDriver::kDepthFrame)));
    }
  }

 private:
  using CompressedImage = idl::sensor_msgs::CompressedImage;

  static dds::TopicSettings SettingsOf(std::string_view name) {
    dds::TopicSettings settings = dds::BuiltInTable().At(name);
    settings.durability = dds::Durability::kVolatile;
    return settings;
  }
  dds::Writer<CompressedImage> Packed(const std::string& name) {
    return {node_.participant.handle(), SettingsOf(dds::kPackedDepthTopic.name), name, {}};
  }
  dds::Writer<idl::sensor_msgs::CameraInfo> Info(const std::string& name) {
    return {node_.participant.handle(), SettingsOf(dds::kDepthCameraInfoTopic.name), name, {}};
  }
  static void Write(dds::Writer<CompressedImage>* writer, std::int64_t stamp_ns,
                    const std::string& format, const std::string& data) {
    dds::Message<CompressedImage> message;
    dds::SetHeader(message->header, stamp_ns, FakeDriver::kDepthFrame);
    dds::SetText(message->format, format);
    dds::Resize(message->data, data.size());
    std::copy(data.begin(), data.end(), message->data._buffer);
    EXPECT_TRUE(writer->Write(message));
  }

  dds::TestNode node_;
  dds::Writer<CompressedImage> depths_;
  dds::Writer<CompressedImage> colors_;
  std::array<dds::Writer<idl::sensor_msgs::CameraInfo>, 2> info_topics_;
};

/// The node in a thread of its own, a driver, and a reader of reports.
class DriverNodeTest : public testing::Test {
 protected:
  struct Answer {
    std::string status, reason;
  };

  DriverNodeTest()
      : test_("test"),
        reports_(test_.participant.CreateReader(dds::kPerceptionReportTopic, test_.Waker())) {
    test_.loop.Attach(reports_, [this] {
      for (const auto& message : reports_.Take()) {
        answers_[dds::StampNs(message.header.stamp)] = {std::string(dds::Text(message.status)),
                                                        std::string(dds::Text(message.reason))};
      }
    });
    test_.loop.Every(std::chrono::milliseconds(5), [] {});  // looks at what others have got
  }
  ~DriverNodeTest() override {
    if (!node_) return;
    node_->Stop();
    thread_.join();
  }

  void StartNode(const NodeConfig& config, bool with_pose = true,
                 const std::vector<dds::FurtherCamera>& cameras = {}) {
    const auto log = [this](Severity, std::string_view line) {
      const std::lock_guard lock(mutex_);
      lines_.emplace_back(line);
    };
    std::optional<Eigen::Isometry3d> T_robot_camera;
    if (with_pose) T_robot_camera = Eigen::Translation3d(0.0, 0.0, 0.5);
    node_ = std::make_unique<PerceptionNode>(config, T_robot_camera, script_.Maker(),
                                             static_cast<int>(dds::TestDomain()),
                                             dds::BuiltInTable(), log, cameras);
    thread_ = std::thread([this] { node_->Run(); });
    ASSERT_TRUE(test_.WaitFor([this] { return reports_.matched() == 1; }));
  }
  void StartWithDriver(const NodeConfig& config = DriverConfig(), bool with_pose = true) {
    StartNode(config, with_pose);
    driver_.emplace();
    ASSERT_TRUE(test_.WaitFor([this] { return driver_->IsRead(); }));
  }
  bool Logs(const std::string& text) {
    return test_.WaitFor([&] {
      const std::lock_guard lock(mutex_);
      for (const std::string& line : lines_) {
        if (line.find(text) != std::string::npos) return true;
      }
      return false;
    });
  }
  bool IsAnswered(std::int64_t stamp_ns) {
    return test_.WaitFor([&] { return answers_.contains(stamp_ns); });
  }
  void SendDepth(std::int64_t stamp_ns, std::uint16_t value = 400) {
    driver_->SendDepth(
        DriverImage<std::uint16_t>("16UC1", {value}, stamp_ns, FakeDriver::kDepthFrame));
  }
  void SendColor(std::int64_t stamp_ns, std::uint8_t value = 7,
                 const std::string& frame = FakeDriver::kDepthFrame) {
    driver_->SendColor(DriverImage<std::uint8_t>("bgr8", {0, 0, value}, stamp_ns, frame));
  }

  Script script_;
  dds::TestNode test_;
  dds::Reader<idl::palpate_msgs::PerceptionReport> reports_;
  std::map<std::int64_t, Answer> answers_;
  std::optional<FakeDriver> driver_;
  std::mutex mutex_;
  std::vector<std::string> lines_;
  std::unique_ptr<PerceptionNode> node_;
  std::thread thread_;
};

TEST_F(DriverNodeTest, DepthInMillimetresAndColourOfAnotherStampMakeAFrame) {
  StartWithDriver();
  SendDepth(100 * kMs);
  SendColor(110 * kMs, 9);
  ASSERT_TRUE(IsAnswered(100 * kMs));
  EXPECT_EQ(answers_[100 * kMs].status, "ok") << answers_[100 * kMs].reason;
  const auto call = script_.calls().at(0);
  EXPECT_EQ(call.depth_value, 400);
  EXPECT_EQ(call.color_value, 9);
  EXPECT_EQ(script_.camera().depth_unit_m, 1e-3);
  EXPECT_EQ(script_.camera().depth.fx_px, 5.0);
  EXPECT_EQ(script_.camera().color.fx_px, 6.0);
}

TEST_F(DriverNodeTest, DepthInMetresIsTheSameFrame) {
  StartWithDriver();
  driver_->SendDepth(DriverImage<float>("32FC1", {0.4f}, 100 * kMs, FakeDriver::kDepthFrame));
  SendColor(100 * kMs);
  ASSERT_TRUE(IsAnswered(100 * kMs));
  EXPECT_EQ(answers_[100 * kMs].status, "ok") << answers_[100 * kMs].reason;
  EXPECT_NEAR(script_.calls().at(0).depth_value * script_.camera().depth_unit_m, 0.4, 2e-5);
}

TEST_F(DriverNodeTest, ColourOfItsOwnCameraStandsWhereTfStaticSays) {
  StartWithDriver();
  driver_->SendTransform(Eigen::Isometry3d(Eigen::Translation3d(0.015, 0.0, 0.0)));
  // /tf_static goes its own way to the node: ask until it is there.
  for (std::int64_t k = 1; k < 100; ++k) {
    SendDepth(k * kPeriod_ns);
    SendColor(k * kPeriod_ns, 7, FakeDriver::kColorFrame);
    ASSERT_TRUE(IsAnswered(k * kPeriod_ns));
    if (answers_[k * kPeriod_ns].status == "ok") break;
    EXPECT_THAT(answers_[k * kPeriod_ns].reason, HasSubstr("/tf_static"));
  }
  EXPECT_EQ(script_.camera().T_depth_color.translation().x(), 0.015);
}

TEST_F(DriverNodeTest, PackedImagesMakeAFrameUnderTheNamesOfTheDriver) {
  NodeConfig config = DriverConfig();
  config.camera.transport = "compressed";
  StartNode(config);
  PackedDriver driver;
  ASSERT_TRUE(test_.WaitFor([&] { return driver.IsRead(); }));
  driver.Send(100 * kMs, 400, 9);
  ASSERT_TRUE(IsAnswered(100 * kMs));
  EXPECT_EQ(answers_[100 * kMs].status, "ok") << answers_[100 * kMs].reason;
  EXPECT_EQ(script_.calls().at(0).depth_value, 400);
  EXPECT_EQ(script_.calls().at(0).color_value, 9);
}

TEST(WithTransports, PackedImagesOfEveryCameraFollowTheRulesOfTheirImages) {
  EXPECT_THAT(
      WithTransports({"/camera/depth/image_raw:=/front", "/camera_back/color/image_raw:=/b",
                      "/camera_back/depth/camera_info:=/i"}),
      testing::ElementsAre("/camera/depth/image_raw:=/front", "/camera_back/color/image_raw:=/b",
                           "/camera_back/depth/camera_info:=/i",
                           "/camera/depth/image_raw/compressedDepth:=/front/compressedDepth",
                           "/camera_back/color/image_raw/compressed:=/b/compressed"));
}

TEST_F(DriverNodeTest, TwoDriversMakeOneFrame) {
  NodeConfig config = DriverConfig();
  config.camera_wait_s = 1.0;
  config.dds.remap.insert(config.dds.remap.end(), kBackRules.begin(), kBackRules.end());
  StartNode(config, true, {{"back", Eigen::Isometry3d(Eigen::Translation3d(0.0, 0.0, -0.5))}});
  driver_.emplace();
  FakeDriver back(dds::Reliability::kBestEffort, "back");
  ASSERT_TRUE(test_.WaitFor([&] { return driver_->IsRead() && back.IsRead(); }));
  SendDepth(100 * kMs);
  SendColor(100 * kMs);
  back.SendDepth(DriverImage<std::uint16_t>("16UC1", {300}, 105 * kMs, "back_depth"));
  back.SendColor(DriverImage<std::uint8_t>("bgr8", {0, 0, 7}, 105 * kMs, "back_depth"));
  ASSERT_TRUE(IsAnswered(100 * kMs));
  EXPECT_EQ(answers_[100 * kMs].status, "ok") << answers_[100 * kMs].reason;
  EXPECT_EQ(script_.calls().at(0).depth_value, 400);
  EXPECT_EQ(script_.calls().at(0).last_depth_value, 300);
}

TEST_F(DriverNodeTest, ACameraThatMovesOnTfIsRefused) {
  StartWithDriver(DriverConfig(), false);
  auto moving = test_.participant.CreateWriter(dds::kTfTopic);
  ASSERT_TRUE(test_.WaitFor([&] { return moving.matched() == 1; }));
  const auto send = [&](double z_m) {
    dds::Message<idl::tf2_msgs::TFMessage> message;
    dds::Resize(message->transforms, 1);
    auto& transform = message->transforms._buffer[0];
    dds::SetHeader(transform.header, 0, "robot");
    dds::SetText(transform.child_frame_id, FakeDriver::kDepthFrame);
    transform.transform.translation.z = z_m;
    transform.transform.rotation.w = 1.0;
    EXPECT_TRUE(moving.Write(message));
    EXPECT_TRUE(moving.WaitUntilReceived(std::chrono::seconds(5)));
  };
  send(0.5);
  SendDepth(1 * kPeriod_ns);
  SendColor(1 * kPeriod_ns);
  ASSERT_TRUE(IsAnswered(1 * kPeriod_ns));
  EXPECT_EQ(answers_[1 * kPeriod_ns].status, "ok") << answers_[1 * kPeriod_ns].reason;
  EXPECT_TRUE(Logs("camera pose of /tf and /tf_static, from 'robot' to"));
  send(0.5 + 1e-5);  // a joint that is held
  SendDepth(2 * kPeriod_ns);
  SendColor(2 * kPeriod_ns);
  ASSERT_TRUE(IsAnswered(2 * kPeriod_ns));
  EXPECT_EQ(answers_[2 * kPeriod_ns].status, "ok") << answers_[2 * kPeriod_ns].reason;
  send(0.6);
  SendDepth(3 * kPeriod_ns);
  SendColor(3 * kPeriod_ns);
  ASSERT_TRUE(IsAnswered(3 * kPeriod_ns));
  EXPECT_EQ(answers_[3 * kPeriod_ns].status, "invalid_input");
  EXPECT_THAT(
      answers_[3 * kPeriod_ns].reason,
      HasSubstr("moves against 'robot' on /tf: a camera on a moving mount is not supported"));
}

TEST_F(DriverNodeTest, UnderJitterAndLossEachFrameHasTheNearestColour) {
  StartWithDriver();
  std::mt19937 random(5);
  std::uniform_int_distribution<std::int64_t> jitter_ns(-5 * kMs, 5 * kMs);
  std::bernoulli_distribution lost(0.1);
  std::map<std::uint8_t, std::int64_t> colors_ns;
  std::map<std::uint16_t, std::int64_t> depths_ns;
  std::int64_t waiting_ns = 0;
  for (int i = 1; i <= 100; ++i) {
    const std::int64_t depth_ns = i * kPeriod_ns + jitter_ns(random);
    const std::int64_t color_ns = i * kPeriod_ns + 12 * kMs + jitter_ns(random);
    const auto depth_value = static_cast<std::uint16_t>(i);
    const auto color_value = static_cast<std::uint8_t>(i);
    if (!lost(random)) {
      SendDepth(depth_ns, depth_value);
      depths_ns[depth_value] = waiting_ns = depth_ns;
    }
    if (lost(random)) continue;
    SendColor(color_ns, color_value);
    colors_ns[color_value] = color_ns;
    if (waiting_ns == 0) continue;
    ASSERT_TRUE(IsAnswered(waiting_ns)) << i;
    waiting_ns = 0;
  }
  const auto calls = script_.calls();
  for (const Script::Call& call : calls) {
    EXPECT_TRUE(call.with_color);
    EXPECT_EQ(call.stamp_ns, depths_ns.at(call.depth_value));
    for (const auto& [value, stamp_ns] : colors_ns) {
      EXPECT_GE(std::abs(stamp_ns - call.stamp_ns),
                std::abs(colors_ns.at(call.color_value) - call.stamp_ns));
    }
  }
  EXPECT_GE(calls.size(), depths_ns.size() * 8 / 10);
  for (const auto& [stamp_ns, answer] : answers_) {
    if (answer.status == "ok") continue;
    EXPECT_EQ(answer.status, "stale");
    EXPECT_THAT(answer.reason, HasSubstr("nothing on /camera/camera/color/image_raw within"));
  }
}

TEST_F(DriverNodeTest, WithoutColourTheDepthAloneIsAFrame) {
  NodeConfig config = DriverConfig();
  config.camera.use_color = false;
  StartNode(config);
  driver_.emplace();
  // Best effort: ask until the writer has found its reader.
  std::int64_t k = 1;
  for (; k < 1000 && answers_.empty(); ++k) {
    SendDepth(k * kPeriod_ns);
    test_.loop.DispatchUntil([this] { return !answers_.empty(); },
                             dds::WaitSet::Clock::now() + std::chrono::milliseconds(10));
  }
  ASSERT_FALSE(answers_.empty());
  SendDepth(k * kPeriod_ns);
  ASSERT_TRUE(IsAnswered(k * kPeriod_ns));
  EXPECT_EQ(answers_[k * kPeriod_ns].status, "ok") << answers_[k * kPeriod_ns].reason;
  EXPECT_FALSE(script_.calls().back().with_color);
}

TEST_F(DriverNodeTest, SaysThatADriverHasNoIntrinsics) {
  StartWithDriver();
  driver_->SendDepth(DriverImage<std::uint16_t>("16UC1", {400}, 100 * kMs, FakeDriver::kDepthFrame),
                     0.0);
  SendColor(100 * kMs);
  ASSERT_TRUE(IsAnswered(100 * kMs));
  EXPECT_EQ(answers_[100 * kMs].status, "no_calibration");
  EXPECT_THAT(answers_[100 * kMs].reason,
              HasSubstr("/camera/camera/depth/camera_info has no intrinsics"));
}

TEST_F(DriverNodeTest, SaysWhichStreamIsNotThere) {
  StartNode(DriverConfig());
  EXPECT_TRUE(Logs("/camera/camera/depth/image_rect_raw"));
  EXPECT_TRUE(Logs("the camera's driver (under another name: --remap) publishes them"));
}

TEST_F(DriverNodeTest, SaysThatTheQosDoesNotMatchAndWhichSettingMendsIt) {
  NodeConfig config = DriverConfig();
  config.camera.reliability = "reliable";
  StartNode(config);
  driver_.emplace();
  EXPECT_TRUE(
      Logs("the publisher's QoS does not match: it is best_effort, reliable is asked for "
           "(camera.reliability)"));
}

TEST_F(DriverNodeTest, AReliableDriverIsReadEitherWay) {
  for (const char* reliability : {"reliable", "best_effort"}) {
    NodeConfig config = DriverConfig();
    config.camera.reliability = reliability;
    FakeDriver reliable(dds::Reliability::kReliable);
    PerceptionNode node(config, std::nullopt, script_.Maker(), static_cast<int>(dds::TestDomain()),
                        dds::BuiltInTable(), {});
    EXPECT_TRUE(test_.WaitFor([&] { return reliable.IsRead(); })) << reliability;
  }
}

TEST_F(DriverNodeTest, TheRobotHangsBelowTheFrameOfTheDriver) {
  StartWithDriver();
  auto transforms = test_.participant.CreateReader(dds::kTfStaticTopic);
  dds::TransformTree tree;
  test_.loop.Attach(transforms, [&] {
    for (const auto& message : transforms.Take()) EXPECT_TRUE(tree.Add(message).ok());
  });
  driver_->SendDepth(DriverImage<std::uint16_t>("16UC1", {400}, 100 * kMs, "zivid_optical_frame"));
  driver_->SendColor(
      DriverImage<std::uint8_t>("rgb8", {1, 2, 3}, 100 * kMs, "zivid_optical_frame"));
  ASSERT_TRUE(IsAnswered(100 * kMs));
  EXPECT_TRUE(test_.WaitFor([&] {
    const auto T_robot_camera = tree.Find("robot", "zivid_optical_frame");
    return T_robot_camera && T_robot_camera->translation().z() == 0.5 &&
           tree.Find("robot", "camera_depth_optical_frame").has_value();
  }));
}

}  // namespace
}  // namespace palpate::perception
