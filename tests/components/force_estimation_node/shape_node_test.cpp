// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>

#include <limits>
#include <string>
#include <thread>
#include <vector>

#include "components/force_estimation/node/node.hpp"
#include "libs/core/error.hpp"
#include "libs/dds/cloud_messages.hpp"
#include "libs/dds/geometry_messages.hpp"
#include "libs/dds/stamp.hpp"
#include "tests/components/force_estimation/node_test_robot.hpp"
#include "tests/components/force_estimation_node/scripted_estimator.hpp"
#include "tests/libs/dds/test_participant.hpp"

/// palpate-force-estimation from the robot's shape.
namespace palpate::force_estimation {
namespace {

using ::testing::HasSubstr;

constexpr double kCable_m = 0.002;
constexpr auto kFrame = "camera_depth_optical_frame";

NodeConfig TestConfig() {
  NodeConfig config;
  config.camera_pose = "{translation_m: [0, 0, 0.5], rotation_xyzw: [1, 0, 0, 0]}";
  config.cable_wait_s = 0.05;
  config.silence_s = 0.2;
  return config;
}

/// What perception publishes of a frame, as a test wants it.
struct Seen {
  std::int64_t stamp_ns = 0;
  Eigen::Index points = 1;
  std::string device = "Palpate-1";
  std::uint32_t epoch = 1;
  std::string status = "ok";
  double contact_x_m = 0.1;
};

/// The node in a thread of its own, and a participant that plays perception, robot and reader.
class ShapeNodeTest : public testing::Test {
 protected:
  ShapeNodeTest()
      : node_(TestConfig(), NodeTestRobot(), 0.0, static_cast<int>(dds::TestDomain()), ManyClouds(),
              {}, script_.Maker()),
        test_("test", ManyClouds()),
        clouds_(test_.participant.CreateWriter(dds::kRobotCloudTopic, test_.Waker())),
        reports_(test_.participant.CreateWriter(dds::kPerceptionReportTopic, test_.Waker())),
        contacts_(test_.participant.CreateWriter(dds::kContactsTopic, test_.Waker())),
        joint_states_(test_.participant.CreateWriter(dds::kJointStatesTopic, test_.Waker())),
        forces_(test_.participant.CreateReader(dds::kForcesTopic, test_.Waker())),
        mesh_states_(test_.participant.CreateReader(dds::kMeshStateTopic, test_.Waker())),
        health_(test_.participant.CreateReader(dds::kComponentStatusTopic)),
        thread_([this] { node_.Run(); }) {
    test_.loop.Attach(forces_, [this] { TakeForces(); });
    test_.loop.Attach(health_, [this] {
      for (const auto& message : health_.Take()) received_ = message.received;
    });
    test_.loop.Attach(mesh_states_, [this] {
      for (const auto& message : mesh_states_.Take()) {
        mesh_state_ns_ = dds::StampNs(message.header.stamp);
        mesh_state_numbers_ = message.positions_m._length;
      }
    });
    EXPECT_TRUE(test_.WaitFor([this] {
      return clouds_.matched() == 1 && reports_.matched() == 1 && contacts_.matched() == 1 &&
             joint_states_.matched() == 1 && forces_.matched() == 1 && mesh_states_.matched() == 1;
    }));
  }
  ~ShapeNodeTest() override {
    script_.Hold(false);
    node_.Stop();
    thread_.join();
  }

  /// Clouds wait for slow readers, so that tests see what the node does, not what DDS drops.
  static dds::TopicTable ManyClouds() {
    return dds::TableWith("/perception/robot_cloud",
                          [](dds::TopicSettings& topic) { topic.depth = 32; });
  }

  struct Answer {
    std::int64_t stamp_ns = 0;
    std::string status, reason, device;
    std::vector<double> force_z_N;
    double age_s = 0.0, latency_s = 0.0;
  };

  void SendCable(std::int64_t stamp_ns) {
    dds::Message<idl::sensor_msgs::JointState> message;
    dds::SetHeader(message->header, stamp_ns, "robot");
    dds::Resize(message->name, 1);
    dds::SetText(message->name._buffer[0], "top");
    dds::SetNumbers(message->position, &kCable_m, 1);
    ASSERT_TRUE(joint_states_.Write(message));
  }
  void SendCloud(const Seen& seen) {
    rgbd::SensedCloud cloud;
    cloud.points_m = Eigen::Matrix3Xf::Constant(3, seen.points, 0.25f);
    cloud.sigma_m = Eigen::VectorXf::Ones(seen.points);
    cloud.colors_rgb.assign(static_cast<std::size_t>(3 * seen.points), 9);
    ASSERT_TRUE(clouds_.Write(dds::ToPointCloud2(cloud, seen.stamp_ns, kFrame)));
  }
  void SendReport(const Seen& seen) {
    dds::Message<idl::palpate_msgs::PerceptionReport> report;
    dds::SetHeader(report->header, seen.stamp_ns, kFrame);
    report->epoch = seen.epoch;
    report->frame_counter = 77;
    dds::SetText(report->device, seen.device);
    dds::SetText(report->status, seen.status);
    dds::SetText(report->reason, "as perception says");
    ASSERT_TRUE(reports_.Write(report));
  }
  void SendContacts(const Seen& seen) {
    dds::Message<idl::palpate_msgs::ContactArray> contacts;
    dds::SetHeader(contacts->header, seen.stamp_ns, kFrame);
    dds::Resize(contacts->contacts, 1);
    auto& contact = contacts->contacts._buffer[0];
    dds::SetText(contact.name, "contact_1");
    contact.position_m = {seen.contact_x_m, 0.2, 0.3};
    contact.position_covariance_m2[1] = contact.position_covariance_m2[3] = 2e-6;
    contact.extent_m = {0.01, 0.02, 0.03};
    contact.point_count = 5;
    ASSERT_TRUE(contacts_.Write(contacts));
  }
  void Send(const Seen& seen) {
    SendCloud(seen);
    SendReport(seen);
    SendContacts(seen);
  }

  /// Sends the frame with its cable input and waits for the answer.
  Answer Ask(const Seen& seen) {
    SendCable(seen.stamp_ns);
    return AskWithoutCable(seen);
  }
  Answer AskWithoutCable(const Seen& seen) {
    const std::size_t before = answers_.size();
    Send(seen);
    EXPECT_TRUE(test_.WaitFor([&] {
      return answers_.size() > before && answers_.back().stamp_ns == seen.stamp_ns;
    })) << seen.stamp_ns;
    return answers_.empty() ? Answer() : answers_.back();
  }

  void TakeForces() {
    for (const auto& message : forces_.Take()) {
      Answer answer{dds::StampNs(message.header.stamp),
                    std::string(dds::Text(message.status)),
                    std::string(dds::Text(message.reason)),
                    std::string(dds::Text(message.recording)),
                    {},
                    message.age_s,
                    message.latency_s};
      for (const auto& force : dds::Elements(message.forces)) {
        answer.force_z_N.push_back(force.force_n.z);
      }
      answers_.push_back(std::move(answer));
    }
  }

  Script script_;
  ForceEstimationNode node_;
  dds::TestNode test_;
  dds::Writer<idl::sensor_msgs::PointCloud2> clouds_;
  dds::Writer<idl::palpate_msgs::PerceptionReport> reports_;
  dds::Writer<idl::palpate_msgs::ContactArray> contacts_;
  dds::Writer<idl::sensor_msgs::JointState> joint_states_;
  dds::Reader<idl::palpate_msgs::ForceArray> forces_;
  dds::Reader<idl::palpate_msgs::MeshState> mesh_states_;
  dds::Reader<idl::palpate_msgs::ComponentStatus> health_;
  std::uint64_t received_ = 0;  ///< by the node, as it says once a second
  std::vector<Answer> answers_;
  std::int64_t mesh_state_ns_ = 0;
  std::uint32_t mesh_state_numbers_ = 0;
  std::thread thread_;
};

TEST_F(ShapeNodeTest, AnswersAFrameUnderItsStampWithAgeAndLatency) {
  const std::int64_t stamp_ns = dds::WallClockNs() - 1'000'000'000;
  const Answer answer = Ask({.stamp_ns = stamp_ns, .points = 3});
  EXPECT_EQ(answer.status, "ok");
  EXPECT_EQ(answer.device, "Palpate-1");
  EXPECT_THAT(answer.force_z_N, ::testing::ElementsAre(3.0));
  EXPECT_GE(answer.age_s, 1.0);
  EXPECT_LT(answer.age_s, 1000.0);
  EXPECT_GT(answer.latency_s, 0.0);
  EXPECT_LT(answer.latency_s, answer.age_s);
  ASSERT_TRUE(test_.WaitFor([&] { return mesh_state_ns_ == stamp_ns; }));
  EXPECT_EQ(mesh_state_numbers_, 3u * 325u);
}

TEST_F(ShapeNodeTest, TheEstimatorSeesCloudCablesAndContactsInTheRobotsFrame) {
  Ask({.stamp_ns = 1'500'000'000});
  const ShapeFrame frame = script_.calls().at(0).seen.frame;
  EXPECT_EQ(frame.t_s, 1.5);
  EXPECT_EQ(frame.cloud.points_m(1, 0), 0.25f);
  EXPECT_EQ(frame.T_robot_camera.translation().z(), 0.5);
  ASSERT_EQ(frame.cables.size(), 1u);
  EXPECT_EQ(frame.cables[0].value, kCable_m);
  ASSERT_EQ(frame.contacts.size(), 1u);
  const SeenContact& contact = frame.contacts[0];
  EXPECT_EQ(contact.name, "contact_1");
  // Turned by 180 degrees about x, then 0.5 m up.
  EXPECT_TRUE(contact.position_m.isApprox(Eigen::Vector3d(0.1, -0.2, 0.2), 1e-14));
  EXPECT_NEAR(contact.covariance_m2(0, 1), -2e-6, 1e-20);
  EXPECT_EQ(contact.extent_m, Eigen::Vector3d(0.01, 0.02, 0.03));
  EXPECT_EQ(contact.point_count, 5);
}

TEST_F(ShapeNodeTest, AFrameThatLostAPartIsLeftOutAndTheNextOneAnswered) {
  SendCable(10);
  SendCloud({.stamp_ns = 10});
  SendContacts({.stamp_ns = 10});
  EXPECT_EQ(Ask({.stamp_ns = 20}).status, "ok");
  EXPECT_EQ(answers_.size(), 1u);
}

TEST_F(ShapeNodeTest, PassesOnWhatPerceptionSays) {
  Ask({.stamp_ns = 10, .points = 0, .status = "stale"});
  const Status looked = script_.calls().at(0).seen.looked;
  EXPECT_EQ(looked.code(), StatusCode::kStale);
  EXPECT_EQ(looked.message(), "as perception says");
  Ask({.stamp_ns = 20});
  EXPECT_TRUE(script_.calls().at(1).seen.looked.ok());
}

TEST_F(ShapeNodeTest, WithoutCableInputsOfItsTimeAFrameIsStaleAndTheNextRecovers) {
  const Answer answer = AskWithoutCable({.stamp_ns = 10});
  EXPECT_EQ(answer.status, "stale");
  EXPECT_THAT(answer.reason, HasSubstr("no cable inputs"));
  // Whoever waits for the model's state is answered, too.
  ASSERT_TRUE(test_.WaitFor([&] { return mesh_state_ns_ == 10; }));
  EXPECT_EQ(mesh_state_numbers_, 0u);
  EXPECT_EQ(Ask({.stamp_ns = 20}).status, "ok");
}

TEST_F(ShapeNodeTest, OfTheFramesThatWaitTheNewestWins) {
  Ask({.stamp_ns = 10});
  script_.Hold(true);
  for (std::int64_t stamp_ns = 20; stamp_ns < 30; ++stamp_ns) {
    SendCable(stamp_ns);
    Send({.stamp_ns = stamp_ns});
    ASSERT_TRUE(test_.WaitFor([&] { return script_.calls().size() == 2; }));
  }
  ASSERT_TRUE(test_.WaitFor([&] { return received_ == 11; }));
  script_.Hold(false);
  ASSERT_TRUE(test_.WaitFor([&] { return answers_.back().stamp_ns == 29; }));
  ASSERT_EQ(script_.calls().size(), 3u);
  EXPECT_EQ(script_.calls()[1].seen.frame.t_s, 20e-9);
  EXPECT_EQ(script_.calls().back().seen.frame.t_s, 29e-9);
}

TEST_F(ShapeNodeTest, SaysStaleOnceASecondWhenTheCloudsStopAndGoesOnWhenTheyComeAgain) {
  Ask({.stamp_ns = 10});
  ASSERT_TRUE(test_.WaitFor([&] { return answers_.size() >= 3; }));
  for (std::size_t i = 1; i < 3; ++i) {
    EXPECT_EQ(answers_[i].status, "stale");
    EXPECT_THAT(answers_[i].reason, HasSubstr("no clouds for"));
    EXPECT_EQ(answers_[i].stamp_ns, 10);
    EXPECT_TRUE(answers_[i].force_z_N.empty());
  }
  EXPECT_GT(answers_[2].age_s, answers_[1].age_s);
  EXPECT_EQ(Ask({.stamp_ns = 20}).status, "ok");
}

TEST_F(ShapeNodeTest, ANewEpochKeepsWhatWasLearntAndAnotherCameraDoesNot) {
  Ask({.stamp_ns = 100, .epoch = 1});
  Ask({.stamp_ns = 200, .epoch = 2});                        // opened anew
  Ask({.stamp_ns = 50, .epoch = 3});                         // the next recording
  Ask({.stamp_ns = 60, .device = "Palpate-2", .epoch = 3});  // another camera
  Ask({.stamp_ns = 50, .device = "Palpate-2", .epoch = 1});  // played again from the start
  const auto calls = script_.calls();
  ASSERT_EQ(calls.size(), 5u);
  EXPECT_EQ(calls[1].estimator, calls[0].estimator);
  EXPECT_EQ(calls[2].estimator, calls[0].estimator);
  EXPECT_NE(calls[3].estimator, calls[0].estimator);
  EXPECT_NE(calls[4].estimator, calls[3].estimator);
}

TEST_F(ShapeNodeTest, AnswersARepeatedFrameAgainWithoutWorkingOnIt) {
  const Answer first = Ask({.stamp_ns = 10, .points = 4});
  const Answer second = AskWithoutCable({.stamp_ns = 10, .points = 4});
  EXPECT_EQ(second.force_z_N, first.force_z_N);
  EXPECT_EQ(script_.calls().size(), 1u);
}

TEST_F(ShapeNodeTest, RefusesAContactThatIsNoNumberAndRecoversWithTheNextFrame) {
  const Answer answer =
      Ask({.stamp_ns = 10, .contact_x_m = std::numeric_limits<double>::quiet_NaN()});
  EXPECT_EQ(answer.status, "invalid_input");
  EXPECT_THAT(answer.reason, HasSubstr("/perception/contacts: contact 'contact_1'"));
  EXPECT_EQ(Ask({.stamp_ns = 20}).status, "ok");
}

TEST(ShapeNode, NeedsACameraPoseWhereNoCalibrationMaySayIt) {
  NodeConfig config;
  config.source = "shape";
  config.follow_calibration = false;
  Script script;
  EXPECT_THROW(
      ForceEstimationNode(config, NodeTestRobot(), 0.0, static_cast<int>(dds::TestDomain()),
                          dds::BuiltInTable(), {}, script.Maker()),
      InputError);
  EXPECT_FALSE(IsFromShape(NodeConfig()));
  EXPECT_TRUE(IsFromShape(TestConfig()));
  config = TestConfig();
  config.source = "markers";
  EXPECT_FALSE(IsFromShape(config));
}

}  // namespace
}  // namespace palpate::force_estimation
