// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/node/node.hpp"

#include <gmock/gmock.h>

#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "components/force_estimation/node/convert.hpp"
#include "libs/dds/stamp.hpp"
#include "tests/components/force_estimation/node/test_robot.hpp"
#include "tests/libs/dds/test_participant.hpp"

namespace palpate::force_estimation {
namespace {

using idl::palpate_msgs::ForceArray;
using idl::palpate_msgs::MarkerArray3;
using ::testing::HasSubstr;

constexpr double kPulled_m = 0.002;

NodeConfig MarkersConfig() {
  NodeConfig config;
  config.frame_tolerance = Config().frame_tolerance;  // forces are compared with the truth
  config.contacts = {"tip: 0, 0.015, 0.03, 0.008"};
  config.cable_wait_s = 0.05;
  return config;
}

/// Positions of the beam's markers with the cable pulled and `force_N` at the contact "tip".
MarkerFrame FrameUnderLoad(const Eigen::Vector3d& force_N, ReferenceShape reference, double t_s) {
  const auto model = NodeTestRobot();
  const std::vector<robot::ActuatorCommand> cables{
      {robot::ActuatorCommand::Kind::kDisplacement, kPulled_m}};
  const auto patch = model->Patch({0.0, 0.015, 0.03}, 0.008);
  fem::StaticState state = model->RestState();
  EXPECT_TRUE(model->Solve(cables, {{patch.weights, force_N}}, &state).status.ok());
  MarkerFrame frame{t_s, reference, {}, cables};
  for (const auto& marker : model->body().markers) {
    frame.markers.push_back(
        {true, marker.point.weights.Position(state.x_m), Eigen::Vector3d::Constant(1e-5)});
  }
  return frame;
}

/// The node in a thread of its own, and a participant that plays robot, motion capture and reader.
class ForceEstimationNodeTest : public testing::Test {
 protected:
  explicit ForceEstimationNodeTest()
      : node_(MarkersConfig(), NodeTestRobot(), {}, static_cast<int>(dds::TestDomain()),
              dds::BuiltInTable(), {}),
        test_("test"),
        markers_(test_.participant.CreateWriter(dds::kMarkersTopic, test_.Waker())),
        joint_states_(test_.participant.CreateWriter(dds::kJointStatesTopic, test_.Waker())),
        forces_(test_.participant.CreateReader(dds::kForcesTopic, test_.Waker())),
        thread_([this] { node_.Run(); }) {
    test_.loop.Attach(forces_, [this] { TakeForces(); });
    EXPECT_TRUE(test_.WaitFor([this] {
      return markers_.matched() == 1 && joint_states_.matched() == 1 && forces_.matched() == 1;
    }));
  }
  ~ForceEstimationNodeTest() override {
    node_.Stop();
    thread_.join();
  }

  struct Answer {
    int64_t stamp_ns;
    std::string status;
    std::string reason;
    std::vector<double> force_z_N;
  };

  void SendCable(int64_t stamp_ns) {
    dds::Message<idl::sensor_msgs::JointState> message;
    dds::SetHeader(message->header, stamp_ns, "robot");
    dds::Resize(message->name, 1);
    dds::SetText(message->name._buffer[0], "top");
    dds::SetNumbers(message->position, &kPulled_m, 1);
    ASSERT_TRUE(joint_states_.Write(message));
  }

  dds::Message<MarkerArray3> ToMessage(const MarkerFrame& frame, uint64_t counter) {
    dds::Message<MarkerArray3> message;
    dds::SetHeader(message->header, std::llround(frame.t_s * 1e9), "robot");
    message->counter = counter;
    message->reference_shape = static_cast<uint8_t>(frame.reference);
    dds::Resize(message->markers, frame.markers.size());
    const std::vector<std::string> names{"Tip-1", "Tip-2", "Tip-3"};
    for (size_t i = 0; i < names.size(); ++i) {
      auto& marker = message->markers._buffer[i];
      const MarkerObservation& source = frame.markers[i];
      dds::SetText(marker.name, names[i]);
      marker.position_m = {source.position_m.x(), source.position_m.y(), source.position_m.z()};
      marker.sigma_m = {source.sigma_m.x(), source.sigma_m.y(), source.sigma_m.z()};
      marker.valid = source.valid;
    }
    return message;
  }

  /// Sends the frame with its cable input and waits for the answer.
  Answer Ask(const dds::Message<MarkerArray3>& message, bool with_cable = true) {
    const int64_t stamp_ns = dds::StampNs(message->header.stamp);
    const size_t before = answers_.size();
    if (with_cable) SendCable(stamp_ns);
    EXPECT_TRUE(markers_.Write(message));
    const bool answered = test_.WaitFor(
        [&] { return answers_.size() > before && answers_.back().stamp_ns == stamp_ns; });
    EXPECT_TRUE(answered);
    return answered ? answers_.back() : Answer{};
  }

  void TakeForces() {
    for (const ForceArray& message : forces_.Take()) {
      Answer answer{dds::StampNs(message.header.stamp),
                    std::string(dds::Text(message.status)),
                    std::string(dds::Text(message.reason)),
                    {}};
      for (const auto& force : dds::Elements(message.forces)) {
        answer.force_z_N.push_back(force.force_n.z);
      }
      answers_.push_back(std::move(answer));
    }
  }

  ForceEstimationNode node_;
  dds::TestNode test_;
  dds::Writer<MarkerArray3> markers_;
  dds::Writer<idl::sensor_msgs::JointState> joint_states_;
  dds::Reader<ForceArray> forces_;
  std::vector<Answer> answers_;
  std::thread thread_;
};

const Eigen::Vector3d kLoad_N(0.0, 0.0, -0.4);

TEST_F(ForceEstimationNodeTest, PublishesTheVeryForcesOfTheEstimator) {
  const MarkerFrame tare =
      FrameUnderLoad(Eigen::Vector3d::Zero(), ReferenceShape::kEquilibrium, 1.0);
  const MarkerFrame loaded = FrameUnderLoad(kLoad_N, ReferenceShape::kNone, 1.1);
  const auto model = NodeTestRobot();
  MarkerForceEstimator estimator(*model, MarkersConfig());
  (void)estimator.Update(tare);
  const ForceEstimate& expected = estimator.Update(loaded);
  ASSERT_TRUE(expected.status.ok()) << expected.status.message();

  EXPECT_EQ(Ask(ToMessage(tare, 0)).status, "no_calibration");
  const Answer answer = Ask(ToMessage(loaded, 1));
  EXPECT_EQ(answer.status, "ok");
  ASSERT_EQ(answer.force_z_N.size(), 1u);
  EXPECT_NEAR(answer.force_z_N[0], expected.contacts[0].force_N.z(), 1e-12);
  EXPECT_NEAR(answer.force_z_N[0], kLoad_N.z(), 1e-6);
}

TEST_F(ForceEstimationNodeTest, PublishesWrenchMeshStateAndModelGapOfTheSameFrame) {
  auto wrenches = test_.participant.CreateReader(dds::kWrenchTopic, {}, "tip");
  auto mesh_states = test_.participant.CreateReader(dds::kMeshStateTopic, test_.Waker());
  auto gaps = test_.participant.CreateReader(dds::kModelGapTopic, test_.Waker());
  ASSERT_TRUE(test_.WaitFor([&] { return mesh_states.matched() == 1 && gaps.matched() == 1; }));
  bool wrench = false, mesh_state = false, gap = false;
  test_.loop.Attach(wrenches, [&] {
    for (const auto& message : wrenches.Take()) wrench = message.wrench.force.z < -0.3;
  });
  test_.loop.Attach(mesh_states, [&] {
    for (const auto& message : mesh_states.Take()) {
      mesh_state = message.positions_m._length == 3 * 325 && dds::Text(message.status) == "ok";
    }
  });
  test_.loop.Attach(gaps, [&] {
    for (const auto& message : gaps.Take()) gap = message.sample_count == 3;
  });
  // The writer of a wrench appears with its first force: ask until its reader has found it.
  for (uint64_t counter = 0; counter < 20 && !wrench; ++counter) {
    Ask(ToMessage(FrameUnderLoad(kLoad_N, ReferenceShape::kNone, 1.0 + double(counter)), counter));
  }
  EXPECT_TRUE(test_.WaitFor([&] { return wrench && mesh_state && gap; }));
}

TEST_F(ForceEstimationNodeTest, ALateJoinerGetsTheMesh) {
  dds::TestNode late("late");
  auto meshes = late.participant.CreateReader(dds::kMeshTopic);
  std::string robot;
  late.loop.Attach(meshes, [&] {
    for (const auto& mesh : meshes.Take()) robot = dds::Text(mesh.robot);
  });
  ASSERT_TRUE(late.WaitFor([&] { return !robot.empty(); }));
  EXPECT_EQ(robot, "beam");
}

TEST_F(ForceEstimationNodeTest, ALateJoinerGetsTheRobotAsUrdf) {
  dds::TestNode late("late");
  auto descriptions = late.participant.CreateReader(dds::kRobotDescriptionTopic);
  std::string urdf;
  late.loop.Attach(descriptions, [&] {
    for (const auto& message : descriptions.Take()) urdf = dds::Text(message.data);
  });
  ASSERT_TRUE(late.WaitFor([&] { return !urdf.empty(); }));
  EXPECT_THAT(urdf, HasSubstr("<robot name=\"beam\">"));
  EXPECT_THAT(urdf, HasSubstr("<link name=\"robot\">"));
}

TEST_F(ForceEstimationNodeTest, SaysWhyItRefusesAFrame) {
  const MarkerFrame frame = FrameUnderLoad(kLoad_N, ReferenceShape::kNone, 1.0);
  auto wrong_frame = ToMessage(frame, 0);
  dds::SetText(wrong_frame->header.frame_id, "camera_depth_optical_frame");
  Answer answer = Ask(wrong_frame);
  EXPECT_EQ(answer.status, "invalid_input");
  EXPECT_THAT(answer.reason, HasSubstr("expected 'robot'"));
  EXPECT_TRUE(answer.force_z_N.empty());

  MarkerFrame later = frame;
  later.t_s = 2.0;
  auto unknown = ToMessage(later, 1);
  dds::SetText(unknown->markers._buffer[0].name, "Tip-9");
  answer = Ask(unknown);
  EXPECT_EQ(answer.status, "invalid_input");
  EXPECT_THAT(answer.reason, HasSubstr("unknown marker 'Tip-9'"));

  MarkerFrame stale = frame;
  stale.t_s = 1.5;
  answer = Ask(ToMessage(stale, 2));
  EXPECT_EQ(answer.status, "stale");
  EXPECT_TRUE(answer.force_z_N.empty());

  later.t_s = 3.0;
  EXPECT_EQ(Ask(ToMessage(later, 3)).status, "ok");
}

TEST_F(ForceEstimationNodeTest, WithoutCableInputsOfItsTimeAFrameIsStale) {
  const Answer answer =
      Ask(ToMessage(FrameUnderLoad(kLoad_N, ReferenceShape::kNone, 1.0), 0), false);
  EXPECT_EQ(answer.status, "stale");
  EXPECT_THAT(answer.reason, HasSubstr("no cable inputs"));
}

TEST_F(ForceEstimationNodeTest, AnswersARepeatedFrameWithTheSameForces) {
  const auto message = ToMessage(FrameUnderLoad(kLoad_N, ReferenceShape::kNone, 1.0), 0);
  const Answer first = Ask(message);
  const Answer second = Ask(message);
  EXPECT_EQ(first.force_z_N, second.force_z_N);
  EXPECT_EQ(second.status, "ok");
}

TEST_F(ForceEstimationNodeTest, ANewSequenceForgetsTheOldTare) {
  MarkerFrame shifted = FrameUnderLoad(kLoad_N, ReferenceShape::kEquilibrium, 1.0);
  Ask(ToMessage(shifted, 0));  // the loaded shape, taken for the unloaded one
  MarkerFrame loaded = FrameUnderLoad(kLoad_N, ReferenceShape::kNone, 1.1);
  EXPECT_EQ(Ask(ToMessage(loaded, 1)).status, "no_contact");

  loaded.t_s = 0.5;
  const Answer answer = Ask(ToMessage(loaded, 0));
  EXPECT_EQ(answer.status, "ok");
  ASSERT_EQ(answer.force_z_N.size(), 1u);
  EXPECT_NEAR(answer.force_z_N[0], kLoad_N.z(), 1e-6);
}

TEST_F(ForceEstimationNodeTest, ShutsDownInTheMiddleOfAFlood) {
  MarkerFrame frame = FrameUnderLoad(kLoad_N, ReferenceShape::kNone, 1.0);
  for (uint64_t counter = 0; counter < 200; ++counter) {
    frame.t_s += 0.01;
    SendCable(std::llround(frame.t_s * 1e9));
    ASSERT_TRUE(markers_.Write(ToMessage(frame, counter)));
  }
  ASSERT_TRUE(test_.WaitFor([&] { return !answers_.empty(); }));
}

TEST_F(ForceEstimationNodeTest, ReportsItsHealthOnDiagnostics) {
  auto diagnostics = test_.participant.CreateReader(dds::kDiagnosticsTopic);
  std::string message, drift, model_gap;
  test_.loop.Attach(diagnostics, [&] {
    for (const auto& array : diagnostics.Take()) {
      message = dds::Text(array.status._buffer[0].message);
      for (const auto& value : dds::Elements(array.status._buffer[0].values)) {
        if (dds::Text(value.key) == "drift") drift = dds::Text(value.value);
        if (dds::Text(value.key) == "model_gap") model_gap = dds::Text(value.value);
      }
    }
  });
  ASSERT_TRUE(test_.WaitFor([&] { return !message.empty(); }));
  EXPECT_THAT(message, HasSubstr("no markers"));
  EXPECT_EQ(drift, "learning");
  EXPECT_EQ(model_gap, "learning");
}

TEST_F(ForceEstimationNodeTest, NamesTheCameraPoseWhereMarkersAreWaitedForByDefault) {
  auto diagnostics = test_.participant.CreateReader(dds::kDiagnosticsTopic);
  std::string waiting;
  test_.loop.Attach(diagnostics, [&] {
    for (const auto& array : diagnostics.Take()) {
      for (const auto& value : dds::Elements(array.status._buffer[0].values)) {
        if (dds::Text(value.key) == "waiting_for") waiting = dds::Text(value.value);
      }
    }
  });
  ASSERT_TRUE(
      test_.WaitFor([&] { return waiting.find("/perception/markers") != std::string::npos; }));
  EXPECT_THAT(waiting, HasSubstr("source auto takes markers, because no --camera-pose is given"));
}

}  // namespace
}  // namespace palpate::force_estimation
