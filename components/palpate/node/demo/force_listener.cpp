// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/node/demo/force_listener.hpp"

#include <utility>

#include "components/palpate/node/live/live_messages.hpp"
#include "libs/dds/stamp.hpp"

namespace palpate::command {

namespace {

constexpr auto kPollPeriod = std::chrono::milliseconds(50);

}  // namespace

ForceListener::ForceListener(int domain_id)
    : participant_(JoinDomain("palpate_demo", domain_id)),
      loop_(participant_),
      forces_(participant_.CreateReader(dds::kForcesTopic)),
      mesh_states_(participant_.CreateReader(dds::kMeshStateTopic)) {
  loop_.Attach(forces_, [this] { TakeForces(); });
  loop_.Attach(mesh_states_, [this] { TakeMeshStates(); });
  loop_.Every(kPollPeriod, [] {});
}

bool ForceListener::Listen(const std::function<bool()>& done, std::chrono::seconds limit) {
  return loop_.DispatchUntil(done, dds::WaitSet::Clock::now() + limit);
}

void ForceListener::TakeForces() {
  for (const idl::palpate_msgs::ForceArray& message : forces_.Take()) {
    estimates_.insert_or_assign(dds::StampNs(message.header.stamp), ToEstimate(message));
  }
}

void ForceListener::TakeMeshStates() {
  for (const idl::palpate_msgs::MeshState& message : mesh_states_.Take()) {
    if (auto nodes_m = ToNodes(message)) mesh_state_m_ = std::move(nodes_m);
  }
}

}  // namespace palpate::command
