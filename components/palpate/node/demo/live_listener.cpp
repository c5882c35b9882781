// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/node/demo/live_listener.hpp"

#include <utility>

#include "components/palpate/node/demo/demo_messages.hpp"
#include "libs/dds/message.hpp"
#include "libs/dds/stamp.hpp"

namespace palpate::command {

namespace {

constexpr auto kPollPeriod = std::chrono::milliseconds(50);
constexpr double kSecondsPerNs = 1e-9;

double Seconds(std::int64_t ns) { return static_cast<double>(ns) * kSecondsPerNs; }

}  // namespace

LiveListener::LiveListener(int domain_id, Truth truth)
    : with_truth_(truth == Truth::kKnown),
      participant_(JoinDomain(domain_id)),
      loop_(participant_),
      forces_(participant_.CreateReader(dds::kForcesTopic)),
      mesh_states_(participant_.CreateReader(dds::kMeshStateTopic)),
      statuses_(participant_.CreateReader(dds::kComponentStatusTopic)),
      comparison_(with_truth_) {
  loop_.Attach(forces_, [this] { TakeForces(); });
  loop_.Attach(mesh_states_, [this] { TakeMeshStates(); });
  loop_.Attach(statuses_, [this] { TakeReports(); });
  loop_.Every(kPollPeriod, [] {});
  if (!with_truth_) return;
  truth_.emplace(participant_.CreateReader(dds::kTrueForcesTopic));
  loop_.Attach(*truth_, [this] { TakeTruth(); });
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
    const std::optional<double> latency_s =
        with_truth_ ? std::optional(Seconds(dds::WallClockNs() - stamp_ns)) : std::nullopt;
    comparison_.AddEstimate(ToEstimate(message), latency_s);
  }
  comparison_.Advance(take_);
}

void LiveListener::TakeTruth() {
  for (const idl::palpate_msgs::ForceArray& message : truth_->Take()) {
    comparison_.AddTruth(Seconds(dds::StampNs(message.header.stamp)), ToTruth(message));
  }
  comparison_.Advance(take_);
}

void LiveListener::TakeMeshStates() {
  for (const idl::palpate_msgs::MeshState& message : mesh_states_.Take()) {
    if (auto nodes_m = ToNodes(message)) {
      comparison_.AddNodes(Seconds(dds::StampNs(message.header.stamp)), std::move(*nodes_m));
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
    if (!trouble.empty()) text += "  " + component + " says " + trouble + "\n";
  }
  return text;
}

}  // namespace palpate::command
