// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/node/node.hpp"

#include <cmath>
#include <utility>

#include "components/force_estimation/node/convert.hpp"
#include "libs/core/text.hpp"
#include "libs/dds/stamp.hpp"

namespace palpate::force_estimation {

namespace {

constexpr auto kReportPeriod = std::chrono::seconds(1);
constexpr auto kCablePeriod = std::chrono::milliseconds(20);
constexpr size_t kMostPending = 1024;

robot::CableInput PreferredInput(const NodeConfig& config) {
  return config.cable_input == "displacement" ? robot::CableInput::kDisplacement
                                              : robot::CableInput::kTension;
}

double SecondsSince(dds::WaitSet::Clock::time_point then) {
  return std::chrono::duration<double>(dds::WaitSet::Clock::now() - then).count();
}

}  // namespace

ForceEstimationNode::ForceEstimationNode(const NodeConfig& config,
                                         std::unique_ptr<robot::RobotModel> model,
                                         double youngs_modulus_relative_sigma, int domain_id,
                                         dds::TopicTable table,
                                         dds::NodeLog::ProcessLog process_log)
    : config_(config),
      participant_(dds::ParticipantOf(config.dds, "palpate_force_estimation", domain_id),
                   std::move(table)),
      loop_(participant_),
      log_(participant_, std::move(process_log)),
      health_(participant_, "force_estimation", Clock::now()),
      worker_(std::move(model), config, youngs_modulus_relative_sigma, [this] { loop_.Wake(); }),
      marker_names_(worker_.model().MarkerNames()),
      cable_names_(worker_.model().CableNames()),
      cables_(cable_names_.size(), PreferredInput(config)),
      outputs_(participant_, worker_.model().body()),
      joint_states_(participant_.CreateReader(dds::kJointStatesTopic)),
      markers_(participant_.CreateReader(dds::kMarkersTopic)) {
  loop_.Attach(joint_states_, [this] { TakeJointStates(); });
  loop_.Attach(markers_, [this] { TakeMarkers(); });
  loop_.OnWake([this] { PublishResults(); });
  loop_.Every(kCablePeriod, [this] { MatchWithCables(); });
  loop_.Every(kReportPeriod, [this] { ReportHealth(); });
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

void ForceEstimationNode::TakeMarkers() {
  for (const auto& message : markers_.Take()) Accept(message);
  MatchWithCables();
}

void ForceEstimationNode::Accept(const idl::palpate_msgs::MarkerArray3& message) {
  ++counts_.received;
  last_frame_ = Clock::now();
  FrameInput input{HeadOf(message, last_frame_), false, {}};
  using Verdict = FrameGate::Verdict;
  const Verdict verdict = gate_.Judge(input.head);
  if (verdict == Verdict::kRepeated) return outputs_.Repeat(input.head);
  if (verdict == Verdict::kStale) {
    return Refuse(input.head, {StatusCode::kStale, "the stamp is not newer than the last one's"});
  }
  if (verdict != Verdict::kNext) {
    cables_.BeginSequence(verdict == Verdict::kTimeWentBack);
    sequence_pending_ = true;
  }
  Status status = FromMarkerArray(message, marker_names_, &input.frame);
  if (status.ok()) {
    status = FrameGate::CheckAge(input.head, dds::WallClockNs(), config_.max_age_s);
  }
  if (!status.ok()) return Refuse(input.head, status);
  input.new_sequence = std::exchange(sequence_pending_, false);
  if (pending_.size() == kMostPending) {
    pending_.pop_front();
    ++counts_.dropped;
  }
  pending_.push_back(std::move(input));
}

void ForceEstimationNode::Refuse(const FrameHead& head, const Status& status) {
  ++counts_.refused;
  last_status_ = status;
  if (std::exchange(last_refusal_, status.message()) != status.message()) {
    log_.Write(Severity::kWarning, "markers refused: " + status.message());
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
    input.frame.cables = std::move(*commands);
    return true;
  }
  if (SecondsSince(input.head.taken) < config_.cable_wait_s) return false;
  *status = cables_.LastBefore(input.head.stamp_ns, config_.max_cable_age_s, &input.frame.cables);
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
  counts.dropped += gate_.lost() + worker_.dropped() + outputs_.failed();
  counts.latencies_s = outputs_.TakeLatencies();
  health_.Report(CurrentStatus(), counts,
                 {{"readers_of_forces", std::to_string(outputs_.readers())},
                  {"writers_of_markers", std::to_string(markers_.matched())},
                  {"incompatible_qos", std::to_string(markers_.counters().incompatible_qos)}},
                 Clock::now());
}

Status ForceEstimationNode::CurrentStatus() const {
  if (counts_.received > 0 && SecondsSince(last_frame_) > config_.silence_s) {
    return {StatusCode::kStale,
            "no markers for " + FormatNumber(std::round(SecondsSince(last_frame_))) + " s"};
  }
  const bool usable = IsUsable(last_status_) || last_status_.code() == StatusCode::kNoCalibration;
  return usable ? Status::Ok() : last_status_;
}

}  // namespace palpate::force_estimation
