// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/node/node.hpp"

#include <cmath>
#include <utility>

#include "components/force_estimation/node/convert.hpp"
#include "components/force_estimation/node/frame_gate.hpp"
#include "components/force_estimation/node/marker_source.hpp"
#include "components/force_estimation/node/shape_source.hpp"
#include "libs/app/yaml.hpp"
#include "libs/core/error.hpp"
#include "libs/core/text.hpp"
#include "libs/dds/stamp.hpp"
#include "libs/geometry/pose_text.hpp"

namespace palpate::force_estimation {

namespace {

constexpr auto kReportPeriod = std::chrono::seconds(1);
constexpr auto kCablePeriod = std::chrono::milliseconds(20);
constexpr size_t kMostPending = 1024;

robot::CableInput PreferredInput(const NodeConfig& config) {
  return config.cable_input == "displacement" ? robot::CableInput::kDisplacement
                                              : robot::CableInput::kTension;
}

Eigen::Isometry3d CameraPose(const NodeConfig& config) {
  if (config.camera_pose.empty()) {
    throw InputError("camera_pose is required for source=shape: where is the camera?");
  }
  return geometry::ReadPose(app::ParseYaml(config.camera_pose, "camera_pose"));
}

double SecondsSince(dds::WaitSet::Clock::time_point then) {
  return std::chrono::duration<double>(dds::WaitSet::Clock::now() - then).count();
}

}  // namespace

ForceEstimationNode::ForceEstimationNode(const NodeConfig& config,
                                         std::unique_ptr<robot::RobotModel> model,
                                         double youngs_modulus_relative_sigma, int domain_id,
                                         dds::TopicTable table,
                                         dds::NodeLog::ProcessLog process_log,
                                         FrameEstimatorMaker maker)
    : config_(config),
      participant_(dds::ParticipantOf(config.dds, "palpate_force_estimation", domain_id),
                   std::move(table)),
      loop_(participant_),
      log_(participant_, std::move(process_log)),
      health_(participant_, "force_estimation", Clock::now()),
      worker_(std::move(model),
              maker ? std::move(maker) : EstimatorMakerOf(config, youngs_modulus_relative_sigma),
              [this] { loop_.Wake(); }),
      cable_names_(worker_.model().CableNames()),
      cables_(cable_names_.size(), PreferredInput(config)),
      outputs_(participant_, worker_.model().body(), IsFromShape(config)),
      joint_states_(participant_.CreateReader(dds::kJointStatesTopic)),
      source_(MakeSource()) {
  last_status_ = {StatusCode::kNotRun, "no " + source_->name() + " on /perception/" +
                                           (IsFromShape(config) ? "robot_cloud" : "markers") +
                                           " yet"};
  cables_.SetDrives(worker_.model().drives());
  loop_.Attach(joint_states_, [this] { TakeJointStates(); });
  loop_.OnWake([this] { PublishResults(); });
  loop_.Every(kCablePeriod, [this] { MatchWithCables(); });
  loop_.Every(kReportPeriod, [this] { ReportHealth(); });
}

std::unique_ptr<FrameSource> ForceEstimationNode::MakeSource() {
  FrameEvents events;
  events.came = [this] {
    ++counts_.received;
    last_frame_ = Clock::now();
  };
  events.sequence = [this](bool time_went_back, bool anew) {
    cables_.BeginSequence(time_went_back);
    sequence_pending_ = sequence_pending_ || anew;
  };
  events.accepted = [this](FrameInput input) { Accept(std::move(input)); };
  events.refused = [this](const FrameHead& head, const Status& status) { Refuse(head, status); };
  events.repeated = [this](const FrameHead& head) { outputs_.Repeat(head); };
  if (IsFromShape(config_)) {
    return std::make_unique<ShapeSource>(participant_, loop_, CameraPose(config_),
                                         std::move(events));
  }
  return std::make_unique<MarkerSource>(participant_, loop_, worker_.model().MarkerNames(),
                                        std::move(events));
}

void ForceEstimationNode::TakeJointStates() {
  for (const auto& message : joint_states_.Take()) {
    CableSample sample;
    const Status status = FromJointState(message, cable_names_, &sample);
    if (status.ok()) {
      cables_.Add(std::move(sample));
    } else {
      ++counts_.refused;
      last_status_ = status;
    }
  }
  MatchWithCables();
}

void ForceEstimationNode::Accept(FrameInput input) {
  const Status status = FrameGate::CheckAge(input.head, dds::WallClockNs(), config_.max_age_s);
  if (!status.ok()) return Refuse(input.head, status);
  input.new_sequence = std::exchange(sequence_pending_, false);
  if (pending_.size() == kMostPending) {
    pending_.pop_front();
    ++counts_.dropped;
  }
  pending_.push_back(std::move(input));
  MatchWithCables();
}

void ForceEstimationNode::Refuse(const FrameHead& head, const Status& status) {
  ++counts_.refused;
  last_status_ = status;
  if (std::exchange(last_refusal_, status.message()) != status.message()) {
    log_.Write(Severity::kWarning, source_->name() + " refused: " + status.message());
  }
  outputs_.PublishRefusal(head, status);
}

void ForceEstimationNode::MatchWithCables() {
  while (!pending_.empty()) {
    Status status = Status::Ok();
    if (!FindCables(pending_.front(), &status)) return;
    FrameInput input = std::move(pending_.front());
    pending_.pop_front();
    if (status.ok()) {
      worker_.Push(std::move(input));
    } else {
      if (input.new_sequence) PassOnNewSequence();
      Refuse(input.head, status);
    }
  }
}

/// The frame that began a sequence was refused: the next one begins it.
void ForceEstimationNode::PassOnNewSequence() {
  (pending_.empty() ? sequence_pending_ : pending_.front().new_sequence) = true;
}

/// False: they may still come.
bool ForceEstimationNode::FindCables(FrameInput& input, Status* status) const {
  if (auto commands = cables_.At(input.head.stamp_ns)) {
    input.cables() = std::move(*commands);
    return true;
  }
  if (SecondsSince(input.head.taken) < config_.cable_wait_s) return false;
  *status = cables_.LastBefore(input.head.stamp_ns, config_.max_cable_age_s, &input.cables());
  return true;
}

void ForceEstimationNode::PublishResults() {
  while (const std::optional<FrameResult> result = worker_.TakeResult()) {
    last_status_ = result->estimate.status;
    outputs_.Publish(*result);
  }
}

void ForceEstimationNode::ReportHealth() {
  dds::HealthCounts counts = counts_;
  counts.published = outputs_.published();
  counts.dropped += source_->dropped() + worker_.dropped() + outputs_.failed();
  counts.latencies_s = outputs_.TakeLatencies();
  const Status status = CurrentStatus();
  if (IsFromShape(config_) && IsSilent()) outputs_.PublishSilence(status);
  health_.Report(status, counts,
                 {{"readers_of_forces", std::to_string(outputs_.readers())},
                  {"writers_of_" + source_->name(), std::to_string(source_->writers())},
                  {"incompatible_qos", std::to_string(source_->incompatible_qos())}},
                 Clock::now());
}

bool ForceEstimationNode::IsSilent() const {
  return counts_.received > 0 && SecondsSince(last_frame_) > config_.silence_s;
}

Status ForceEstimationNode::CurrentStatus() const {
  if (IsSilent()) {
    return {StatusCode::kStale, "no " + source_->name() + " for " +
                                    FormatNumber(std::round(SecondsSince(last_frame_))) + " s"};
  }
  const bool usable = IsUsable(last_status_) || last_status_.code() == StatusCode::kNoCalibration;
  return usable ? Status::Ok() : last_status_;
}

}  // namespace palpate::force_estimation
