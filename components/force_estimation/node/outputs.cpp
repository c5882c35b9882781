// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/node/outputs.hpp"

#include <utility>

#include "components/force_estimation/node/convert.hpp"
#include "libs/core/seconds.hpp"

namespace palpate::force_estimation {

namespace {

bool HasWrench(const ContactForce& contact) {
  return IsUsable(contact.status) || contact.status.code() == StatusCode::kHidden;
}

}  // namespace

Outputs::Outputs(dds::Participant& participant, const robot::RobotBody& body, bool answer_always,
                 std::vector<std::string> given_contacts)
    : participant_(participant),
      body_(body),
      answer_always_(answer_always),
      forces_(participant.CreateWriter(dds::kForcesTopic)),
      mesh_state_(participant.CreateWriter(dds::kMeshStateTopic)),
      mesh_(participant.CreateWriter(dds::kMeshTopic)),
      model_gap_(participant.CreateWriter(dds::kModelGapTopic)),
      wrench_array_(participant.CreateWriter(dds::kWrenchesTopic)),
      description_(participant.CreateWriter(dds::kRobotDescriptionTopic)),
      wrench_slots_(std::move(given_contacts)) {
  failed_ += mesh_.Write(ToMesh(body_, participant.Now_ns())) ? 0 : 1;
  failed_ += description_.Write(ToDescription(body_)) ? 0 : 1;
}

void Outputs::Publish(const FrameResult& result) {
  const ForceEstimate& estimate = result.estimate;
  const bool tried = estimate.status.code() != StatusCode::kNoCalibration;
  if (tried || answer_always_) SendMeshState(ToMeshState(result, body_.mesh_hash));
  if (tried) {
    auto gap = ToModelGap(result);
    gap->counter = model_gap_counter_++;
    failed_ += model_gap_.Write(gap) ? 0 : 1;
  }
  PublishWrenches(result.head, estimate.contacts);
  Answer(result.head, ToForceArray(result.head, estimate.status, estimate.contacts));
}

void Outputs::PublishPosture(const FrameResult& result) {
  SendMeshState(ToMeshState(result, body_.mesh_hash));
}

void Outputs::PublishRefusal(const FrameHead& head, const Status& status) {
  if (answer_always_) SendMeshState(NoMeshState(head, status, body_.mesh_hash));
  PublishWrenches(head, {});
  Answer(head, ToForceArray(head, status, {}));
}

void Outputs::PublishSilence(const Status& status) {
  auto message = ToForceArray(last_head_, status, {});
  Send(last_head_, message);
}

void Outputs::Answer(const FrameHead& head, dds::Message<idl::palpate_msgs::ForceArray> message) {
  Send(head, message);
  latencies_s_.push_back(message->latency_s);
  last_head_ = head;
  last_forces_ = std::move(message);
  answered_ = true;
}

void Outputs::Send(const FrameHead& head, dds::Message<idl::palpate_msgs::ForceArray>& message) {
  message->counter = forces_counter_++;
  message->age_s = NsToSeconds(participant_.clock()->NowOfFrames_ns() - head.stamp_ns);
  message->latency_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - head.taken).count();
  failed_ += forces_.Write(message) ? 0 : 1;
}

void Outputs::SendMeshState(dds::Message<idl::palpate_msgs::MeshState> message) {
  message->counter = mesh_state_counter_++;
  failed_ += mesh_state_.Write(message) ? 0 : 1;
}

void Outputs::Repeat(const FrameHead& head) {
  if (!answered_ || last_head_.stamp_ns != head.stamp_ns || last_head_.counter != head.counter ||
      last_head_.recording != head.recording) {
    return;
  }
  last_forces_->counter = forces_counter_++;
  failed_ += forces_.Write(last_forces_) ? 0 : 1;
}

void Outputs::PublishWrenches(const FrameHead& head, const std::vector<ContactForce>& contacts) {
  std::vector<ContactWrench> wrenches;
  for (const ContactForce& contact : contacts) {
    if (HasWrench(contact)) wrenches.push_back({contact, PublishWrench(head.stamp_ns, contact)});
  }
  auto message = ToWrenchArray(head.stamp_ns, wrenches);
  message->counter = wrench_array_counter_++;
  failed_ += wrench_array_.Write(message) ? 0 : 1;
}

std::string Outputs::PublishWrench(int64_t stamp_ns, const ContactForce& contact) {
  const std::string name = wrench_slots_.NameOf(contact.name, stamp_ns);
  if (name.empty()) {
    ++failed_;
    return {};
  }
  auto writer = wrenches_.find(name);
  if (writer == wrenches_.end()) {
    writer = wrenches_.emplace(name, participant_.CreateWriter(dds::kWrenchTopic, {}, name)).first;
  }
  failed_ += writer->second.Write(ToWrench(stamp_ns, contact)) ? 0 : 1;
  return writer->second.ros_name();
}

uint64_t Outputs::failed() const { return failed_; }

std::vector<double> Outputs::TakeLatencies() { return std::exchange(latencies_s_, {}); }

}  // namespace palpate::force_estimation
