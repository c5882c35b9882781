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

std::vector<Parameter> WithFault(std::vector<Parameter> parameters, CommandedFault* fault) {
  if (parameters.empty() && fault == nullptr) return parameters;
  for (Parameter& parameter : FaultParameters(fault)) parameters.push_back(std::move(parameter));
  return parameters;
}

TopicTable WithRawKept(const TopicTable& table, bool remote_raw) {
  std::vector<TopicSettings> rows = table.topics();
  for (TopicSettings& row : rows) row.this_host_only = row.raw && !remote_raw;
  return TopicTable(std::move(rows));
}

/// Whether the node uses `topic` under this name. Of a name with a part that is known at run time
/// only, rules hold that rename no single one.
bool IsNameOf(const TopicSettings& topic, const std::string& ros_name, const TopicNames& names) {
  if (topic.name.find("<name>") == topic.name.npos) return names.Resolve(topic) == ros_name;
  const std::string any = names.Resolve(topic, "*");
  const std::size_t before = any.find('*');
  const std::size_t after = any.size() - before - 1;
  if (ros_name.size() <= before + after) return false;
  const std::string part = ros_name.substr(before, ros_name.size() - before - after);
  return names.Resolve(topic, part) == ros_name;
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
      fault_(settings.allow_faults ? std::make_shared<CommandedFault>([this](const auto& line) {
        WriteLog(Severity::kWarning, line);
      })
                                   : nullptr),
      parameters_(
          MakeParameters(entity_.handle(), names_, WithFault(settings.parameters, fault_.get()))) {
  if (parameters_) graph_.Add(parameters_->writers(), parameters_->readers());
  if (!settings.use_sim_time) return;
  const TopicSettings& topic = table_.At(kClockTopic.name);
  clock_ = std::make_shared<RosClock>(handle(), topic, names_.Resolve(topic));
  graph_.AddReader(clock_->reader()->handle());
}

bool Participant::IsData(std::string_view topic_name) const {
  return !table_.At(topic_name).global && topic_name != kComponentStatusTopic.name;
}

RawWriterTopic Participant::KeptHere(RawWriterTopic topic) const {
  constexpr std::string_view kPrefix = "rt/";
  if (!topic.dds_topic.starts_with(kPrefix)) return topic;
  const std::string ros_name = topic.dds_topic.substr(kPrefix.size() - 1);
  for (const TopicSettings& row : table_.topics()) {
    if (row.this_host_only && IsNameOf(row, ros_name, names_)) topic.this_host_only = true;
  }
  return topic;
}

}  // namespace palpate::dds
