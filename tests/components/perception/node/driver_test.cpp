// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>

#include <cstdlib>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "components/perception/node/node.hpp"
#include "tests/components/perception/node/driver_fixture.hpp"
#include "tests/components/perception/node/scripted_perception.hpp"

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

  void StartNode(const NodeConfig& config) {
    const auto log = [this](Severity, std::string_view line) {
      const std::lock_guard lock(mutex_);
      lines_.emplace_back(line);
    };
    const Eigen::Isometry3d T_robot_camera(Eigen::Translation3d(0.0, 0.0, 0.5));
    node_ = std::make_unique<PerceptionNode>(config, T_robot_camera, script_.Maker(),
                                             static_cast<int>(dds::TestDomain()),
                                             dds::BuiltInTable(), log);
    thread_ = std::thread([this] { node_->Run(); });
    ASSERT_TRUE(test_.WaitFor([this] { return reports_.matched() == 1; }));
  }
  void StartWithDriver(const NodeConfig& config = DriverConfig()) {
    StartNode(config);
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
