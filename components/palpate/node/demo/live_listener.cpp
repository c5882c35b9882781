// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/node/demo/live_listener.hpp"

#include <utility>

#include "components/palpate/node/live/live_messages.hpp"
#include "libs/core/seconds.hpp"
#include "libs/dds/message.hpp"
#include "libs/dds/stamp.hpp"

namespace palpate::command {

namespace {

constexpr auto kLivePollPeriod = std::chrono::milliseconds(50);

}  // namespace

LiveListener::LiveListener(int domain_id, Truth truth, const std::vector<std::string>& remap,
                           double same_place_m)
    : with_truth_(truth == Truth::kKnown),
      participant_(JoinDomain("palpate_demo", domain_id, remap)),
      loop_(participant_),
      forces_(participant_.CreateReader(dds::kForcesTopic)),
      mesh_states_(participant_.CreateReader(dds::kMeshStateTopic)),
      statuses_(participant_.CreateReader(dds::kComponentStatusTopic)),
      comparison_(with_truth_, same_place_m) {
  loop_.Attach(forces_, [this] { TakeForces(); });
  loop_.Attach(mesh_states_, [this] { TakeMeshStates(); });
  loop_.Attach(statuses_, [this] { TakeReports(); });
  loop_.Every(kLivePollPeriod, [] {});
  if (!with_truth_) return;
  bench_.emplace(BenchReaders{participant_.CreateReader(dds::kTrueForcesTopic),
                              participant_.CreateReader(dds::kFrameInfoTopic),
                              participant_.CreateReader(dds::kPerceptionReportTopic),
                              participant_.CreateReader(dds::kBenchStateTopic)});
  loop_.Attach(bench_->truth, [this] { TakeTruth(); });
  loop_.Attach(bench_->frames, [this] { TakeFrameInfos(); });
  loop_.Attach(bench_->perceived, [this] { TakePerceived(); });
  loop_.Attach(bench_->state, [this] {
    for (const auto& message : bench_->state.Take()) bench_time_ = {message.recording, message.t_s};
  });
}

bool LiveListener::Listen(const std::function<bool()>& done, std::chrono::duration<double> limit,
                          const LiveComparison::TakeFrame& take) {
  take_ = take;
  const auto deadline =
      dds::WaitSet::Clock::now() + std::chrono::duration_cast<dds::WaitSet::Clock::duration>(limit);
  return loop_.DispatchUntil(done, deadline);
}

void LiveListener::TakeForces() {
  TakeMeshStates();
  for (const idl::palpate_msgs::ForceArray& message : forces_.Take()) {
    const std::int64_t stamp_ns = dds::StampNs(message.header.stamp);
    const force_estimation::ForceEstimate estimate = ToEstimate(message);
    std::optional<double> latency_s;
    if (bench_) {
      latency_s = NsToSeconds(dds::WallClockNs() - stamp_ns);
      if (HasResult(estimate.status)) PassEstimated(message, *latency_s);
    }
    comparison_.AddEstimate(estimate, latency_s);
  }
  comparison_.Advance(take_);
}

void LiveListener::PassEstimated(const idl::palpate_msgs::ForceArray& message, double heard_s) {
  TakeFrameInfos();
  TakePerceived();
  const std::int64_t stamp_ns = dds::StampNs(message.header.stamp);
  stages_.Pass(stamp_ns, Milestone::kEstimating, message.age_s - message.latency_s);
  stages_.Pass(stamp_ns, Milestone::kEstimated, message.age_s);
  stages_.Pass(stamp_ns, Milestone::kHeard, heard_s);
  stages_.Finish(stamp_ns);
}

void LiveListener::TakeFrameInfos() {
  const auto messages = bench_->frames.Take();
  for (auto message = messages.begin(); message != messages.end(); ++message) {
    const idl::palpate_msgs::FrameInfo& info = *message;
    const std::int64_t stamp_ns = dds::StampNs(info.header.stamp);
    stages_.Pass(stamp_ns, Milestone::kReceived, NsToSeconds(info.stamp_receive_ns - stamp_ns));
    stages_.Pass(stamp_ns, Milestone::kPublished, NsToSeconds(message.sent_ns() - stamp_ns));
  }
}

void LiveListener::TakePerceived() {
  for (const idl::palpate_msgs::PerceptionReport& message : bench_->perceived.Take()) {
    const std::int64_t stamp_ns = dds::StampNs(message.header.stamp);
    stages_.Pass(stamp_ns, Milestone::kPerceiving, message.age_s - message.latency_s);
    stages_.Pass(stamp_ns, Milestone::kPerceived, message.age_s);
  }
}

void LiveListener::TakeTruth() {
  for (const idl::palpate_msgs::ForceArray& message : bench_->truth.Take()) {
    stages_.AddState(dds::StampNs(message.header.stamp));
    comparison_.AddTruth(NsToSeconds(dds::StampNs(message.header.stamp)), ToTruth(message));
  }
  comparison_.Advance(take_);
}

void LiveListener::TakeMeshStates() {
  for (const idl::palpate_msgs::MeshState& message : mesh_states_.Take()) {
    if (auto nodes_m = ToNodes(message)) {
      comparison_.AddNodes(NsToSeconds(dds::StampNs(message.header.stamp)), std::move(*nodes_m));
    }
  }
}

void LiveListener::TakeReports() {
  for (const idl::palpate_msgs::ComponentStatus& message : statuses_.Take()) {
    const std::string status(dds::Text(message.status));
    reports_[std::string(dds::Text(message.component_name))] =
        status == ToString(StatusCode::kOk)
            ? std::string()
            : status + ": " + std::string(dds::Text(message.reason));
  }
}

std::string LiveListener::Troubles() const {
  std::string text;
  for (const auto& [component, trouble] : reports_) {
    if (!trouble.empty()) text += "  status of " + component + ": " + trouble + "\n";
  }
  return text;
}

}  // namespace palpate::command
