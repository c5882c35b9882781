// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/participant.hpp"

#include "libs/core/error.hpp"
#include "libs/dds/qos.hpp"
#include "libs/dds/ros_names.hpp"

namespace palpate::dds {

namespace {

Entity CreateParticipant(const ParticipantSettings& settings) {
  return Entity(dds_create_participant(settings.domain_id, ParticipantQos().get(), nullptr),
                "a participant in domain " + std::to_string(settings.domain_id) +
                    " (is a network interface up, and CYCLONEDDS_URI right? `lo` needs multicast "
                    "or unicast peers)");
}

}  // namespace

Participant::Participant(const ParticipantSettings& settings, TopicTable table)
    : node_name_(settings.node_name),
      domain_id_(settings.domain_id),
      table_(std::move(table)),
      domain_(ApplyDomainSettings(settings.domain_id)),
      entity_(CreateParticipant(settings)),
      graph_(entity_.handle(), settings.node_namespace, settings.node_name, settings.gid_layout) {}

std::string Participant::RosName(std::string_view topic_name, const std::string& name) {
  constexpr std::string_view kPlaceholder = "<name>";
  std::string ros_name(topic_name);
  const size_t at = ros_name.find(kPlaceholder);
  PALPATE_CHECK((at == ros_name.npos) == name.empty(), topic_name, name);
  return at == ros_name.npos ? ros_name : ros_name.replace(at, kPlaceholder.size(), name);
}

}  // namespace palpate::dds
