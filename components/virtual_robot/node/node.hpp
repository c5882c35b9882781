// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "components/virtual_robot/node/answers.hpp"
#include "components/virtual_robot/node/bench_clock.hpp"
#include "components/virtual_robot/node/config.hpp"
#include "components/virtual_robot/node/convert.hpp"
#include "components/virtual_robot/virtual_robot.hpp"
#include "libs/dds/health.hpp"
#include "libs/dds/input_monitor.hpp"
#include "libs/dds/node_log.hpp"
#include "libs/dds/wait_set.hpp"
#include "libs/scenario/schedule.hpp"

namespace palpate::virtual_robot {

/// What the node runs.
struct BenchSetup {
  std::unique_ptr<VirtualRobot> robot;
  std::string robot_name;
  std::vector<std::string> cables;
  scenario::Schedule schedule;
  std::string scenario_sha256;
  std::uint64_t seed = 0;
};

/// Runs a scenario in real time and publishes the actuator readings and, apart, the truth.
class VirtualRobotNode {
 public:
  /// Throws InputError for bad settings, RunError where DDS refuses.
  VirtualRobotNode(const NodeConfig& config, BenchSetup bench, int domain_id, dds::TopicTable table,
                   dds::NodeLog::ProcessLog process_log);

  /// Until Stop(), or the scenario's end where it is not repeated. Throws RunError where the robot
  /// finds no equilibrium to start from.
  void Run();
  /// From any thread.
  void Stop() { loop_.Stop(); }

 private:
  void TakeCommands();
  void AwaitAnswers();
  void Step();
  scenario::BenchInputs InputsNow();
  void Publish(const scenario::BenchInputs& inputs, const scenario::Moment& moment);
  template <typename T>
  void Send(dds::Writer<T>& writer, dds::Message<T> message);
  Status StatusNow() const;
  void ReportHealth();

  NodeConfig config_;
  BenchSetup bench_;
  dds::Participant participant_;
  dds::WaitSet loop_;
  dds::NodeLog log_;
  dds::HealthReporter health_;
  dds::Reader<idl::sensor_msgs::JointState> commands_;
  dds::Writer<idl::sensor_msgs::JointState> joint_states_;
  dds::Writer<idl::palpate_msgs::Mesh> mesh_;
  dds::Writer<idl::palpate_msgs::MeshState> mesh_state_;
  dds::Writer<idl::palpate_msgs::ForceArray> forces_;
  dds::Writer<idl::palpate_msgs::BenchState> bench_state_;
  std::optional<dds::Writer<idl::rosgraph_msgs::Clock>> ros_clock_;  ///< with publish_clock
  std::optional<Answers> answers_;                                   ///< with most_ahead
  BenchClock clock_;
  double pass_start_s_ = 0.0;  ///< of the present pass through the scenario, bench time
  Eigen::VectorXd commanded_m_;
  std::int64_t last_command_ns_;
  std::uint64_t counter_ = 0;
  Status physics_;
  dds::HealthCounts counts_;
  dds::InputMonitor inputs_;
};

}  // namespace palpate::virtual_robot
