// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/virtual_robot/node/node.hpp"

#include <gmock/gmock.h>

#include <limits>
#include <memory>
#include <set>
#include <thread>

#include "libs/dds/stamp.hpp"
#include "libs/robot/robot_description.hpp"
#include "libs/scenario/robot_names.hpp"
#include "tests/libs/dds/test_participant.hpp"
#include "tests/support/robots.hpp"

namespace palpate::virtual_robot {
namespace {

using dds::TestNode;
using ::testing::HasSubstr;

/// One recording without end, in which north is pulled by 2 mm and a ball stands aside.
scenario::Scenario OneRecording() {
  scenario::Scenario scenario;
  scenario.name = "test";
  scenario.body.refine = 0;
  scenario.body.element = "tet4";
  scenario.rest_between_s = 0.05;
  scenario.tools.resize(1);
  scenario.tools[0].name = "ball";
  scenario::RecordingPlan plan;
  plan.name = "pull";
  plan.duration_s = 600.0;
  plan.commands = {{"north"}, {{0.0, Eigen::VectorXd::Constant(1, 0.002)}}};
  scenario::Waypoint aside;
  aside.T_robot_tool.translation() = Eigen::Vector3d(0.3, 0.0, 0.2);
  plan.tool_paths = {{"ball", {aside}}};
  scenario.recordings = {plan};
  return scenario;
}

BenchSetup Setup(const scenario::Scenario& scenario) {
  const auto robot = test_support::FourLegRobot();
  const auto names = scenario::NamesOf(robot);
  return {std::make_unique<VirtualRobot>(robot, scenario, std::vector<scenario::ActiveEffect>{}, 1),
          robot.name,
          names.cables,
          scenario::Schedule(scenario, names.Actuators()),
          "hash",
          1};
}

/// The node, running; stopped and joined at the end.
class RunningNode {
 public:
  explicit RunningNode(const NodeConfig& config,
                       const scenario::Scenario& scenario = OneRecording())
      : node_(config, Setup(scenario), static_cast<int>(dds::TestDomain()), dds::BuiltInTable(),
              {}),
        thread_([this] { node_.Run(); }) {}
  ~RunningNode() {
    node_.Stop();
    Join();
  }
  void Join() {
    if (thread_.joinable()) thread_.join();
  }

 private:
  VirtualRobotNode node_;
  std::thread thread_;
};

/// Everything that the bench says, the newest of each.
class Listener {
 public:
  Listener()
      : node_("listener"),
        commands(node_.participant.CreateWriter(dds::kRobotCommandTopic, node_.Waker())),
        joint_states_(node_.participant.CreateReader(dds::kJointStatesTopic)),
        mesh_(node_.participant.CreateReader(dds::kTrueMeshTopic)),
        mesh_states_(node_.participant.CreateReader(dds::kTrueMeshStateTopic)),
        bench_(node_.participant.CreateReader(dds::kBenchStateTopic)),
        status_(node_.participant.CreateReader(dds::kComponentStatusTopic)) {
    node_.loop.Attach(joint_states_, [this] {
      for (const auto& message : joint_states_.Take()) {
        displacement_m.assign(message.position._buffer,
                              message.position._buffer + message.position._length);
      }
    });
    node_.loop.Attach(mesh_, [this] {
      for (const auto& message : mesh_.Take()) node_count = message.nodes_m._length / 3;
    });
    node_.loop.Attach(mesh_states_, [this] {
      for (const auto& message : mesh_states_.Take()) {
        last_stamp_ns = dds::StampNs(message.header.stamp);
        state_node_count = message.positions_m._length / 3;
        ++states;
      }
    });
    node_.loop.Attach(bench_, [this] {
      for (const auto& message : bench_.Take()) {
        bench_stamps_ns.push_back(dds::StampNs(message.header.stamp));
        recording_s = message.t_s;
        tools = message.tools._length;
      }
    });
    node_.loop.Attach(status_, [this] {
      for (const auto& message : status_.Take()) {
        status = dds::Text(message.status);
        reason = dds::Text(message.reason);
        refused = message.refused;
      }
    });
  }

  template <typename Condition>
  bool WaitFor(const Condition& condition) {
    return node_.WaitFor(condition);
  }

 private:
  TestNode node_;

 public:
  dds::Writer<idl::sensor_msgs::JointState> commands;
  std::vector<double> displacement_m;
  size_t node_count = 0;
  size_t state_node_count = 0;
  size_t states = 0;
  size_t tools = 0;
  std::int64_t last_stamp_ns = 0;
  std::vector<std::int64_t> bench_stamps_ns;
  double recording_s = -1.0;
  std::string status;
  std::string reason;
  std::uint64_t refused = 0;

 private:
  dds::Reader<idl::sensor_msgs::JointState> joint_states_;
  dds::Reader<idl::palpate_msgs::Mesh> mesh_;
  dds::Reader<idl::palpate_msgs::MeshState> mesh_states_;
  dds::Reader<idl::palpate_msgs::BenchState> bench_;
  dds::Reader<idl::palpate_msgs::ComponentStatus> status_;
};

dds::Message<idl::sensor_msgs::JointState> Pull(const std::string& cable, double displacement_m) {
  dds::Message<idl::sensor_msgs::JointState> message;
  dds::Resize(message->name, 1);
  dds::SetText(message->name._buffer[0], cable);
  dds::SetNumbers(message->position, &displacement_m, 1);
  return message;
}

TEST(VirtualRobotNode, TheClockIsTheStampOfTheState) {
  dds::TestNode listener("listener");
  auto clock = listener.participant.CreateReader(dds::kClockTopic);
  auto states = listener.participant.CreateReader(dds::kJointStatesTopic);
  std::set<std::int64_t> times_ns;
  bool met = false;
  listener.loop.Attach(clock, [&] {
    for (const auto& message : clock.Take()) times_ns.insert(dds::StampNs(message.clock));
  });
  listener.loop.Attach(states, [&] {
    for (const auto& message : states.Take()) {
      met = met || times_ns.contains(dds::StampNs(message.header.stamp));
    }
  });
  NodeConfig config;
  config.publish_clock = true;
  const RunningNode node(config);
  EXPECT_TRUE(listener.WaitFor([&] { return met; }));
}

TEST(VirtualRobotNode, PublishesDrivesAndTruthOfTheSameInstant) {
  Listener listener;
  const RunningNode node({});
  ASSERT_TRUE(listener.WaitFor([&] { return listener.states >= 5 && listener.tools == 1; }));
  ASSERT_EQ(listener.displacement_m.size(), 4u);
  EXPECT_NEAR(listener.displacement_m[0], 0.002, 1e-9);
  EXPECT_GT(listener.node_count, 100u);
  EXPECT_EQ(listener.state_node_count, listener.node_count);
  EXPECT_THAT(listener.bench_stamps_ns, ::testing::Contains(listener.last_stamp_ns));
}

TEST(VirtualRobotNode, ALateListenerGetsTheMesh) {
  const RunningNode node({});
  Listener first;
  ASSERT_TRUE(first.WaitFor([&] { return first.states >= 3; }));
  Listener late;
  EXPECT_TRUE(late.WaitFor([&] { return late.node_count > 0; }));
}

TEST(VirtualRobotNode, TakesCommandsFromTheTopicWhereItIsTold) {
  NodeConfig config;
  config.commands = "topic";
  Listener listener;
  const RunningNode node(config);
  ASSERT_TRUE(listener.WaitFor([&] { return listener.commands.matched() > 0; }));
  ASSERT_TRUE(listener.commands.Write(Pull("east", 0.003)));
  EXPECT_TRUE(listener.WaitFor(
      [&] { return listener.displacement_m.size() == 4 && listener.displacement_m[3] == 0.003; }));
}

TEST(VirtualRobotNode, RefusesACommandToAStrangeCableAndSaysSo) {
  NodeConfig config;
  config.commands = "topic";
  Listener listener;
  const RunningNode node(config);
  ASSERT_TRUE(listener.WaitFor([&] { return listener.commands.matched() > 0; }));
  ASSERT_TRUE(listener.commands.Write(Pull("up", 0.003)));
  EXPECT_TRUE(listener.WaitFor([&] { return listener.refused == 1; }));
}

TEST(VirtualRobotNode, SaysThatCommandsHaveStopped) {
  NodeConfig config;
  config.commands = "topic";
  config.command_timeout_s = 0.2;
  Listener listener;
  const RunningNode node(config);
  EXPECT_TRUE(listener.WaitFor([&] { return listener.status == "stale"; }));
  EXPECT_THAT(listener.reason, HasSubstr("/robot/command"));
}

/// Each answer lets one state pass. It gives none before: 5 s are longer than all others take.
TEST(VirtualRobotNode, IsNoFurtherAheadOfTheForcesThanItMayBe) {
  NodeConfig config;
  config.rate_hz = 200.0;
  config.most_ahead = 2;
  TestNode estimator("estimator");
  auto forces = estimator.participant.CreateWriter(dds::kForcesTopic, estimator.Waker());
  Listener listener;
  const RunningNode node(config);
  ASSERT_TRUE(estimator.WaitFor([&] { return forces.matched() > 0; }));
  for (std::size_t answered = 0; answered < 20; ++answered) {
    const auto& stamps_ns = listener.bench_stamps_ns;
    ASSERT_TRUE(listener.WaitFor([&] { return stamps_ns.size() >= answered + 2; }));
    EXPECT_EQ(stamps_ns.size(), answered + 2);
    dds::Message<idl::palpate_msgs::ForceArray> answer;
    dds::SetHeader(answer->header, stamps_ns[answered], "robot");
    ASSERT_TRUE(forces.Write(answer));
  }
}

TEST(VirtualRobotNode, GoesOnWhereNoForcesCome) {
  NodeConfig config;
  config.most_ahead = 1;
  Listener listener;
  const RunningNode node(config);
  EXPECT_TRUE(listener.WaitFor([&] { return listener.states >= 2; }));
}

TEST(VirtualRobotNode, EndsWithTheScenarioWhereItIsNotRepeated) {
  NodeConfig config;
  config.repeat = false;
  scenario::Scenario scenario = OneRecording();
  scenario.recordings[0].duration_s = 0.2;
  RunningNode node(config, scenario);
  node.Join();
}

TEST(VirtualRobotNode, BeginsAgainWhereItIsRepeated) {
  scenario::Scenario scenario = OneRecording();
  scenario.recordings[0].duration_s = 0.2;
  Listener listener;
  const RunningNode node({}, scenario);
  double latest_s = -1.0;
  const bool again = listener.WaitFor([&] {
    const bool back = listener.recording_s < latest_s;
    latest_s = listener.recording_s;
    return back;
  });
  EXPECT_TRUE(again);
}

}  // namespace
}  // namespace palpate::virtual_robot
