// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/node/outputs.hpp"

#include <utility>

#include "components/force_estimation/node/convert.hpp"
#include "libs/dds/ros_names.hpp"
#include "libs/dds/stamp.hpp"

namespace palpate::force_estimation {

namespace {
constexpr size_t kMostWrenches = 64;
}  // namespace

Outputs::Outputs(dds::Participant& participant, const robot::RobotBody& body)
    : participant_(participant),
      body_(body),
      forces_(participant.CreateWriter(dds::kForcesTopic)),
      mesh_state_(participant.CreateWriter(dds::kMeshStateTopic)),
      mesh_(participant.CreateWriter(dds::kMeshTopic)),
      model_gap_(participant.CreateWriter(dds::kModelGapTopic)) {
  failed_ += mesh_.Write(ToMesh(body_, dds::WallClockNs())) ? 0 : 1;
}

void Outputs::Publish(const FrameResult& result) {
  const ForceEstimate& estimate = result.estimate;
  if (estimate.status.code() != StatusCode::kNoCalibration) {
    auto mesh_state = ToMeshState(result, body_.mesh_hash);
    mesh_state->counter = mesh_state_counter_++;
    failed_ += mesh_state_.Write(mesh_state) ? 0 : 1;
    auto gap = ToModelGap(result);
    gap->counter = model_gap_counter_++;
    failed_ += model_gap_.Write(gap) ? 0 : 1;
  }
  for (const ContactForce& contact : estimate.contacts) {
    if (IsUsable(contact.status)) PublishWrench(result.head.stamp_ns, contact);
  }
  Answer(result.head, ToForceArray(result.head, estimate.status, estimate.contacts));
}

void Outputs::PublishRefusal(const FrameHead& head, const Status& status) {
  Answer(head, ToForceArray(head, status, {}));
}

void Outputs::Answer(const FrameHead& head, dds::Message<idl::palpate_msgs::ForceArray> message) {
  message->counter = forces_counter_++;
  message->latency_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - head.taken).count();
  latencies_s_.push_back(message->latency_s);
  failed_ += forces_.Write(message) ? 0 : 1;
  last_head_ = head;
  last_forces_ = std::move(message);
  answered_ = true;
}

void Outputs::Repeat(const FrameHead& head) {
  if (!answered_ || last_head_.stamp_ns != head.stamp_ns || last_head_.counter != head.counter ||
      last_head_.recording != head.recording) {
    return;
  }
  last_forces_->counter = forces_counter_++;
  failed_ += forces_.Write(last_forces_) ? 0 : 1;
}

void Outputs::PublishWrench(int64_t stamp_ns, const ContactForce& contact) {
  const std::string name = dds::RosNamePart(contact.name);
  auto writer = wrenches_.find(name);
  if (writer == wrenches_.end()) {
    if (wrenches_.size() == kMostWrenches) {
      ++failed_;
      return;
    }
    writer = wrenches_.emplace(name, participant_.CreateWriter(dds::kWrenchTopic, {}, name)).first;
  }
  failed_ += writer->second.Write(ToWrench(stamp_ns, contact)) ? 0 : 1;
}

uint64_t Outputs::failed() const { return failed_; }

std::vector<double> Outputs::TakeLatencies() { return std::exchange(latencies_s_, {}); }

}  // namespace palpate::force_estimation
