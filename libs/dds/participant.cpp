// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/participant.hpp"

#include <utility>
#include <vector>

#include "libs/dds/ros_names.hpp"

namespace palpate::dds {

namespace {

std::unique_ptr<ParameterServices> MakeParameters(dds_entity_t participant, const TopicNames& names,
                                                  const std::vector<Parameter>& parameters) {
  if (parameters.empty()) return nullptr;
  const std::string& node_namespace = names.node_namespace();
  const std::string node = (node_namespace == "/" ? "" : node_namespace) + "/" + names.node_name();
  try {
    return std::make_unique<ParameterServices>(participant, node, parameters);
  } catch (const NotAllowed&) {
    return nullptr;
  }
}

TopicTable WithRawKept(const TopicTable& table, bool remote_raw) {
  std::vector<TopicSettings> rows = table.topics();
  for (TopicSettings& row : rows) row.this_host_only = row.raw && !remote_raw;
  return TopicTable(std::move(rows));
}

}  // namespace

Participant::Participant(const ParticipantSettings& settings, TopicTable table)
    : domain_id_(settings.domain_id),
      table_(WithRawKept(table, settings.remote_raw)),
      names_(settings.node_name, settings.node_namespace, settings.remap, table_),
      domain_(ApplyDomainSettings(settings.domain_id, settings.security.enabled())),
      entity_(CreateParticipant(settings.domain_id, settings.security)),
      graph_(entity_.handle(), names_.node_namespace(), names_.node_name(), settings.gid_layout),
      clock_(std::make_shared<RosClock>()),
      parameters_(MakeParameters(entity_.handle(), names_, settings.parameters)) {
  if (parameters_) graph_.Add(parameters_->writers(), parameters_->readers());
  if (!settings.use_sim_time) return;
  const TopicSettings& topic = table_.At(kClockTopic.name);
  clock_ = std::make_shared<RosClock>(handle(), topic, names_.Resolve(topic));
  graph_.AddReader(clock_->reader()->handle());
}

RawWriterTopic Participant::KeptHere(RawWriterTopic topic) const {
  for (const TopicSettings& row : table_.topics()) {
    if (row.this_host_only && DdsTopicName(names_.Resolve(row)) == topic.dds_topic) {
      topic.this_host_only = true;
    }
  }
  return topic;
}

}  // namespace palpate::dds
