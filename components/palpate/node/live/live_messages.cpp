// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/node/live/live_messages.hpp"

#include <string>

#include "components/palpate/compare/status_word.hpp"
#include "libs/app/yaml.hpp"
#include "libs/core/index.hpp"
#include "libs/dds/access_rights.hpp"
#include "libs/dds/message.hpp"
#include "libs/dds/node_settings.hpp"
#include "libs/dds/stamp.hpp"

namespace palpate::command {

Status ParseStatus(std::string_view word, std::string_view reason) {
  if (const auto code = StatusOfWord(word)) return {*code, std::string(reason)};
  return {StatusCode::kInvalidInput, "unknown status '" + std::string(word) + "'"};
}

dds::Participant JoinDomain(const std::string& node_name, int domain_id,
                            const std::vector<std::string>& remap) {
  dds::NodeSettings settings;
  settings.remap = remap;
  dds::ParticipantSettings participant = dds::ParticipantOf(settings, node_name, domain_id);
  participant.security = dds::SecurityOf(settings, dds::kObserver);
  return dds::Participant(participant,
                          dds::LoadTopicTable(settings, app::LoadYaml, app::ParseYaml));
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
    contact.covariance_N2 = Eigen::Matrix3d::Map(force.covariance_n2);
    contact.ci95_N = force.ci95_n;
    contact.location_ci95_m = force.location_ci95_m;
    contact.location_covariance_m2 = Eigen::Matrix3d::Map(force.location_covariance_m2);
    estimate.contacts.push_back(contact);
  }
  return estimate;
}

std::vector<TrueContact> ToTruth(const idl::palpate_msgs::ForceArray& message) {
  std::vector<TrueContact> contacts;
  for (const force_estimation::ContactForce& contact : ToEstimate(message).contacts) {
    contacts.push_back({contact.name, contact.position_m, contact.force_N});
  }
  return contacts;
}

std::optional<Eigen::VectorXd> ToNodes(const idl::palpate_msgs::MeshState& message) {
  const Status status = ParseStatus(dds::Text(message.status), "");
  const auto count = ToIndex(message.positions_m._length);
  const bool usable = status.ok() || status.code() == StatusCode::kNoContact;
  if (!usable || count == 0) return std::nullopt;
  return Eigen::Map<const Eigen::VectorXf>(message.positions_m._buffer, count).cast<double>();
}

}  // namespace palpate::command
