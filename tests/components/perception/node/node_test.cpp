// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <limits>

#include "tests/components/perception/node/node_fixture.hpp"

namespace palpate::perception {
namespace {

using ::testing::HasSubstr;

TEST_F(PerceptionNodeTest, GivesCloudsReportAndContactsTheStampOfTheFrame) {
  StartNode(TestConfig());
  std::int64_t robot_ns = 0, object_ns = 0, contacts_ns = 0;
  rgbd::SensedCloud robot;
  std::uint32_t object_points = 0;
  std::string frame_id, name;
  double covariance_m2 = 0.0;
  test_.loop.Attach(robots_, [&] {
    for (const auto& message : robots_.Take()) {
      robot_ns = dds::StampNs(message.header.stamp);
      EXPECT_TRUE(dds::FromPointCloud2(message, &robot).ok());
    }
  });
  test_.loop.Attach(objects_, [&] {
    for (const auto& message : objects_.Take()) {
      object_ns = dds::StampNs(message.header.stamp);
      object_points = message.width;
    }
  });
  test_.loop.Attach(contacts_, [&] {
    for (const auto& message : contacts_.Take()) {
      contacts_ns = dds::StampNs(message.header.stamp);
      frame_id = dds::Text(message.header.frame_id);
      ASSERT_EQ(message.contacts._length, 1u);
      name = dds::Text(message.contacts._buffer[0].name);
      covariance_m2 = message.contacts._buffer[0].position_covariance_m2[1];
    }
  });
  SendCamera(SmallCamera(), 1, 5);
  const std::int64_t stamp_ns = dds::WallClockNs() - kSecond_ns;
  const Answer answer = Ask(stamp_ns);
  EXPECT_EQ(answer.status, "ok") << answer.reason;
  ASSERT_TRUE(test_.WaitFor([&] { return contacts_ns == stamp_ns && object_ns == stamp_ns; }));
  EXPECT_EQ(answer.picture, rgbd::PictureOf(SmallCamera().depth));
  EXPECT_EQ(robot_ns, stamp_ns);
  ASSERT_EQ(robot.Count(), 1);
  EXPECT_EQ(robot.points_m(2, 0), 0.4f);
  EXPECT_EQ(object_points, 2u);
  EXPECT_EQ(frame_id, "camera_depth_optical_frame");
  EXPECT_EQ(name, "contact_1");
  EXPECT_EQ(covariance_m2, 2e-6);
  EXPECT_GE(answer.age_s, 1.0);
  EXPECT_LT(answer.age_s, 1000.0);
  EXPECT_GT(answer.latency_s, 0.0);
  EXPECT_LT(answer.latency_s, answer.age_s);
  EXPECT_EQ(script_.calls().at(0).stamp_ns, stamp_ns);
  EXPECT_TRUE(script_.calls().at(0).with_color);
}

TEST_F(PerceptionNodeTest, OfTheFramesThatWaitTheNewestWins) {
  StartNode(TestConfig());
  SendCamera(SmallCamera(), 1, 5);
  script_.Hold(true);
  for (std::int64_t stamp_ns = 10; stamp_ns < 20; ++stamp_ns) {
    SendFrame(stamp_ns);
    ASSERT_TRUE(test_.WaitFor([&] { return !script_.calls().empty(); }));
  }
  ASSERT_TRUE(test_.WaitFor([&] { return received_ == 10; }));
  script_.Hold(false);
  ASSERT_TRUE(WaitForAnswer(19));
  ASSERT_EQ(script_.calls().size(), 2u);
  EXPECT_EQ(script_.calls()[0].stamp_ns, 10);
  EXPECT_EQ(script_.calls()[1].stamp_ns, 19);
  EXPECT_EQ(answers_.size(), 2u);
}

TEST_F(PerceptionNodeTest, SaysThatColourIsMissingAndGoesOnWithTheNextFrame) {
  StartNode(TestConfig());
  SendCamera(SmallCamera(), 1, 5);
  EXPECT_EQ(Ask(10).status, "ok");
  rgbd::RgbdFrame images = Images();
  images.color = {};
  const Answer answer = Ask(20, images);
  EXPECT_EQ(answer.status, "stale");
  EXPECT_THAT(answer.reason, HasSubstr("/camera/color/image_raw"));
  EXPECT_EQ(Ask(30).status, "ok");
  EXPECT_EQ(script_.calls().size(), 2u);
}

TEST_F(PerceptionNodeTest, WorksWithACameraThatHasNoColour) {
  StartNode(TestConfig());
  rgbd::RgbdCamera camera = SmallCamera();
  camera.color = {};
  camera.color_registered = false;
  SendCamera(camera, 1, 5);
  rgbd::RgbdFrame images = Images();
  images.color = {};
  EXPECT_EQ(Ask(10, images).status, "ok");
  EXPECT_EQ(Ask(20, images).status, "ok");
  EXPECT_FALSE(script_.calls().at(1).with_color);
  EXPECT_EQ(script_.camera().color.width_px, 0);
}

TEST_F(PerceptionNodeTest, SaysThatTheSetupIsMissingUntilItComes) {
  StartNode(TestConfig());
  epoch_ = 1;
  Answer answer = Ask(10);
  EXPECT_EQ(answer.status, "no_calibration");
  EXPECT_THAT(answer.reason, HasSubstr("/camera/setup"));
  SendCamera(SmallCamera(), 1, 5);
  EXPECT_EQ(Ask(20).status, "ok");
  epoch_ = 2;
  answer = Ask(30);
  EXPECT_EQ(answer.status, "no_calibration");
  EXPECT_THAT(answer.reason, HasSubstr("epoch 2"));
}

TEST_F(PerceptionNodeTest, RefusesIntrinsicsThatAreNoNumbersAndRecoversWithTheNextEpoch) {
  StartNode(TestConfig());
  rgbd::RgbdCamera camera = SmallCamera();
  camera.depth.fx_px = std::numeric_limits<double>::quiet_NaN();
  SendCamera(camera, 1, 5);
  const Answer answer = Ask(10);
  EXPECT_EQ(answer.status, "invalid_input");
  EXPECT_THAT(answer.reason, HasSubstr("/camera/depth/camera_info: intrinsics"));
  SendCamera(SmallCamera(), 2, 15);
  EXPECT_EQ(Ask(20).status, "ok");
}

TEST_F(PerceptionNodeTest, RefusesImagesOfAnotherSizeAndRecoversWithTheNextFrame) {
  StartNode(TestConfig());
  SendCamera(SmallCamera(), 1, 5);
  rgbd::RgbdFrame images = Images();
  images.depth = rgbd::DepthImage(5, 3, 1);
  Answer answer = Ask(10, images);
  EXPECT_EQ(answer.status, "invalid_input");
  EXPECT_THAT(answer.reason, HasSubstr("a depth image of 5 x 3 pixels from a camera of 4 x 3"));
  images = Images();
  images.color = rgbd::ColorImage(4, 2, 1);
  answer = Ask(20, images);
  EXPECT_EQ(answer.status, "invalid_input");
  EXPECT_THAT(answer.reason, HasSubstr("a colour image of 4 x 2"));
  EXPECT_EQ(Ask(30).status, "ok");
}

TEST_F(PerceptionNodeTest, ANewEpochSetsTheCameraAnewAndAnotherDeviceForgetsEverything) {
  StartNode(TestConfig());
  SendCamera(SmallCamera(), 1, 5);
  Ask(10);
  Ask(20);
  rgbd::RgbdCamera moved = SmallCamera();
  moved.depth.cx_px = moved.color.cx_px = 1.75;
  SendCamera(moved, 2, 25);
  Ask(30);
  EXPECT_EQ(script_.camera().depth.cx_px, 1.75);
  SendCamera(SmallCamera(), 3, 35, "Palpate-2");
  Ask(40);
  const auto calls = script_.calls();
  ASSERT_EQ(calls.size(), 4u);
  EXPECT_EQ(calls[1].cameras, 1);
  EXPECT_EQ(calls[2].cameras, 2);
  EXPECT_EQ(calls[2].perception, calls[0].perception);
  EXPECT_NE(calls[3].perception, calls[0].perception);
  EXPECT_EQ(calls[3].cameras, 1);
}

TEST_F(PerceptionNodeTest, AStampThatIsNotNewerNeedsANewSetup) {
  StartNode(TestConfig());
  SendCamera(SmallCamera(), 1, 5);
  Ask(20);
  SendFrame(15);
  Ask(30);
  EXPECT_EQ(script_.calls().size(), 2u);
  SendCamera(SmallCamera(), 1, 1);
  EXPECT_EQ(Ask(15).status, "ok");
  EXPECT_NE(script_.calls().at(2).perception, script_.calls().at(0).perception);
  EXPECT_EQ(script_.calls().at(2).cameras, 1);
}

TEST_F(PerceptionNodeTest, AnswersARepeatedFrameAgainWithoutWorkingOnIt) {
  StartNode(TestConfig());
  SendCamera(SmallCamera(), 1, 5);
  const Answer first = Ask(10);
  SendFrame(10);
  ASSERT_TRUE(test_.WaitFor([&] { return answers_.size() == 2; }));
  EXPECT_EQ(answers_[1].stamp_ns, 10);
  EXPECT_GT(answers_[1].counter, first.counter);
  EXPECT_EQ(script_.calls().size(), 1u);
}

TEST_F(PerceptionNodeTest, TheCamerasOwnDisparityNoiseWins) {
  StartNode(TestConfig());
  SendCamera(SmallCamera(), 1, 5, "Palpate-1", 0.123);
  Ask(10);
  EXPECT_EQ(script_.config().depth_subpixel_px, 0.123);
}

}  // namespace
}  // namespace palpate::perception
