// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/node/force_listener.hpp"

#include <string>

#include "libs/app/yaml.hpp"
#include "libs/dds/message.hpp"
#include "libs/dds/node_settings.hpp"
#include "libs/dds/stamp.hpp"

namespace palpate::command {

namespace {

constexpr auto kPollPeriod = std::chrono::milliseconds(50);

dds::Participant JoinDomain(int domain_id) {
  const dds::NodeSettings settings;
  return dds::Participant(dds::ParticipantOf(settings, "palpate_demo", domain_id),
                          dds::LoadTopicTable(settings, app::LoadYaml, app::ParseYaml));
}

// The status behind a word of forces.csv; a word that is not known cannot be relied on.
Status ParseStatus(std::string_view word, std::string_view reason) {
  for (int code = 0; code <= static_cast<int>(StatusCode::kInvalidInput); ++code) {
    if (ToString(static_cast<StatusCode>(code)) == word) {
      return {static_cast<StatusCode>(code), std::string(reason)};
    }
  }
  return {StatusCode::kInvalidInput, "unknown status '" + std::string(word) + "'"};
}

force_estimation::ForceEstimate ToEstimate(const idl::palpate_msgs::ForceArray& message) {
  force_estimation::ForceEstimate estimate;
  estimate.t_s = static_cast<double>(dds::StampNs(message.header.stamp)) * 1e-9;
  estimate.status = ParseStatus(dds::Text(message.status), dds::Text(message.reason));
  for (const auto& force : dds::Elements(message.forces)) {
    force_estimation::ContactForce contact;
    contact.status = ParseStatus(dds::Text(force.status), dds::Text(force.reason));
    contact.name = dds::Text(force.name);
    contact.position_m = {force.position_m.x, force.position_m.y, force.position_m.z};
    contact.force_N = {force.force_n.x, force.force_n.y, force.force_n.z};
    contact.ci95_N = force.ci95_n;
    contact.location_ci95_m = force.location_ci95_m;
    estimate.contacts.push_back(contact);
  }
  return estimate;
}

}  // namespace

ForceListener::ForceListener(int domain_id)
    : participant_(JoinDomain(domain_id)),
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
    const Status status = ParseStatus(dds::Text(message.status), "");
    if (status.ok() || status.code() == StatusCode::kNoContact) {
      const auto count = static_cast<Eigen::Index>(message.positions_m._length);
      mesh_state_m_ =
          Eigen::Map<const Eigen::VectorXf>(message.positions_m._buffer, count).cast<double>();
    }
  }
}

}  // namespace palpate::command
