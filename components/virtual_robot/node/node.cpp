// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/virtual_robot/node/node.hpp"

#include <limits>
#include <utility>

#include "libs/core/clock.hpp"
#include "libs/core/error.hpp"
#include "libs/core/index.hpp"
#include "libs/core/seconds.hpp"
#include "libs/core/text.hpp"
#include "libs/dds/geometry_messages.hpp"
#include "libs/dds/stamp.hpp"

namespace palpate::virtual_robot {

namespace {

using Clock = dds::WaitSet::Clock;

constexpr auto kReportPeriod = std::chrono::seconds(1);
/// The first frames of a sequence, in which contacts are searched without a limit, take seconds.
constexpr auto kLongestAnswer = std::chrono::seconds(5);

double Seconds(Clock::time_point time) { return ToSeconds(time.time_since_epoch()); }

Clock::time_point TimePoint(double seconds) { return Clock::time_point(FromSeconds(seconds)); }

Eigen::VectorXd NothingDriven(size_t cables) {
  return Eigen::VectorXd::Constant(ToIndex(cables), std::numeric_limits<double>::quiet_NaN());
}

}  // namespace

VirtualRobotNode::VirtualRobotNode(const NodeConfig& config, BenchSetup bench, int domain_id,
                                   dds::TopicTable table, dds::NodeLog::ProcessLog process_log)
    : config_{config},
      bench_{std::move(bench)},
      participant_{dds::ParticipantOf(config.dds, "palpate_virtual_robot", domain_id),
                   std::move(table)},
      loop_{participant_},
      log_{participant_, std::move(process_log)},
      health_{participant_, "virtual_robot", Clock::now()},
      commands_{participant_.CreateReader(dds::kRobotCommandTopic)},
      joint_states_{participant_.CreateWriter(dds::kJointStatesTopic)},
      mesh_{participant_.CreateWriter(dds::kTrueMeshTopic)},
      mesh_state_{participant_.CreateWriter(dds::kTrueMeshStateTopic)},
      forces_{participant_.CreateWriter(dds::kTrueForcesTopic)},
      bench_state_{participant_.CreateWriter(dds::kBenchStateTopic)},
      clock_{1.0 / config.rate_hz, config.max_step_s},
      commanded_m_{NothingDriven(bench_.cables.size())},
      last_command_ns_{MonotonicNow_ns()},
      inputs_{participant_, loop_, log_} {
  if (config.most_ahead > 0) answers_.emplace(participant_, loop_);
  if (config.publish_clock) ros_clock_.emplace(participant_.CreateWriter(dds::kClockTopic));
  inputs_.Expect(commands_, "the controller", dds::InputKind::kStream,
                 [this] { return config_.commands == "topic"; });
  loop_.Attach(commands_, [this] { TakeCommands(); });
  loop_.Every(kReportPeriod, [this] { ReportHealth(); });
}

void VirtualRobotNode::Run() {
  physics_ = bench_.robot->Start(0.0, InputsNow());
  if (!physics_.ok()) throw RunError("the virtual robot does not start: " + physics_.message());
  const VirtualRobot& robot = *bench_.robot;
  Send(mesh_, dds::ToMesh({bench_.robot_name, robot.mesh_hash(), robot.mesh().nodes_m,
                           robot.mesh().cells, robot.boundary().DrawnTriangles()},
                          dds::WallClockNs()));
  log_.Write(Severity::kInfo, "static equilibrium reached; scenario '" +
                                  bench_.schedule.scenario().name + "' of " +
                                  FormatNumber(bench_.schedule.Duration_s()) + " s begins");
  clock_.Start(Seconds(Clock::now()));
  while (!loop_.stopped()) {
    loop_.DispatchUntil([] { return false; }, TimePoint(clock_.Due_s()));
    AwaitAnswers();
    if (loop_.stopped() || Clock::now() < TimePoint(clock_.Due_s())) continue;
    Step();
    const bool over = clock_.bench_s() - pass_start_s_ >= bench_.schedule.Duration_s();
    if (over && !config_.repeat) break;
    if (over) pass_start_s_ += bench_.schedule.Duration_s();
  }
  ReportHealth();
}

/// An answer that does not come, as where the frames of all states were lost, is not awaited again.
void VirtualRobotNode::AwaitAnswers() {
  if (!answers_) return;
  const auto most = static_cast<std::size_t>(config_.most_ahead);
  const auto is_near = [&] { return answers_->Unanswered() < most; };
  if (!loop_.DispatchUntil(is_near, Clock::now() + kLongestAnswer)) answers_->Forget();
}

void VirtualRobotNode::Step() {
  const std::uint64_t missed_before = clock_.missed();
  const Clock::time_point now = Clock::now();
  const double bench_s = clock_.Tick(Seconds(now));
  counts_.dropped += clock_.missed() - missed_before;
  const scenario::BenchInputs inputs = InputsNow();
  physics_ = bench_.robot->Advance(bench_s, inputs);
  counts_.latencies_s.push_back(Seconds(Clock::now()) - Seconds(now));
  if (!physics_.ok()) {
    ++counts_.refused;
    log_.WarnRepeatedly("no new state: " + physics_.message());
    return;
  }
  Publish(inputs, bench_.schedule.At(bench_s - pass_start_s_));
}

scenario::BenchInputs VirtualRobotNode::InputsNow() {
  scenario::BenchInputs inputs = bench_.schedule.InputsAt(clock_.bench_s() - pass_start_s_);
  if (config_.commands == "topic") inputs.displacement_m = commanded_m_;
  return inputs;
}

void VirtualRobotNode::Publish(const scenario::BenchInputs& inputs,
                               const scenario::Moment& moment) {
  const std::int64_t stamp_ns = dds::WallClockNs();
  if (ros_clock_) {
    dds::Message<idl::rosgraph_msgs::Clock> now;
    now->clock = dds::TimeFromNs(stamp_ns);
    Send(*ros_clock_, std::move(now));
  }
  const VirtualRobot& robot = *bench_.robot;
  const auto& scenario = bench_.schedule.scenario();
  const auto& plan = scenario.recordings[At(moment.recording)];
  BenchFacts facts{bench_.scenario_sha256, bench_.seed, moment, Eigen::Isometry3d::Identity()};
  if (scenario.camera) {
    facts.T_robot_camera = plan.T_robot_camera.value_or(scenario.camera->T_robot_camera);
  }
  const std::string recording = moment.t_s >= 0.0 ? plan.name : std::string();
  Send(joint_states_, ToJointState(bench_.cables, robot.cables(), stamp_ns));
  auto forces = ToForceArray(robot.forces(), recording, stamp_ns);
  forces->counter = counter_;
  Send(forces_, std::move(forces));
  auto bench_state = ToBenchState(facts, inputs.tools, stamp_ns);
  bench_state->counter = counter_;
  Send(bench_state_, std::move(bench_state));
  // Last, so that whoever takes it has what belongs to it already.
  auto mesh_state = dds::ToMeshState(robot.positions_m(), robot.mesh_hash(), stamp_ns);
  mesh_state->counter = counter_++;
  Send(mesh_state_, std::move(mesh_state));
  if (answers_) answers_->NoteSent(stamp_ns);
  ++counts_.published;
}

template <typename T>
void VirtualRobotNode::Send(dds::Writer<T>& writer, dds::Message<T> message) {
  if (!writer.Write(message)) ++counts_.dropped;
}

void VirtualRobotNode::TakeCommands() {
  for (const idl::sensor_msgs::JointState& message : commands_.Take()) {
    ++counts_.received;
    const Status status = FromCommand(message, bench_.cables, &commanded_m_);
    if (status.ok()) {
      last_command_ns_ = MonotonicNow_ns();
      continue;
    }
    ++counts_.refused;
    log_.WarnRepeatedly("command refused: " + status.message(),
                        dds::StampText(dds::StampNs(message.header.stamp)));
  }
}

Status VirtualRobotNode::StatusNow() const {
  if (!physics_.ok()) return physics_;
  const double silent_s = NsToSeconds(MonotonicNow_ns() - last_command_ns_);
  if (config_.commands == "topic" && silent_s > config_.command_timeout_s) {
    return {StatusCode::kStale, "no command on /robot/command for " + FormatNumber(silent_s) +
                                    " s: the last command stays"};
  }
  return Status::Ok();
}

void VirtualRobotNode::ReportHealth() {
  const auto moment = bench_.schedule.At(clock_.bench_s() - pass_start_s_);
  const auto& plan = bench_.schedule.scenario().recordings[At(moment.recording)];
  health_.Report(StatusNow(), counts_,
                 {{"recording", plan.name},
                  {"t_s", FormatNumber(moment.t_s)},
                  {"waiting_for", inputs_.Waiting()}},
                 Clock::now());
  counts_.latencies_s.clear();
  log_.WriteCounted();
}

}  // namespace palpate::virtual_robot
