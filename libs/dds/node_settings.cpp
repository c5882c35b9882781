// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/node_settings.hpp"

#include <utility>

namespace palpate::dds {

TopicTable LoadTopicTable(const NodeSettings& settings, const ConfigLoader& load,
                          const ConfigParser& parse) {
  return ReadTopicTable(settings.topics_file.empty()
                            ? parse(std::string(BuiltInTopicsYaml()), "config/topics.yaml")
                            : load(settings.topics_file));
}

ParticipantSettings ParticipantOf(const NodeSettings& settings, std::string node_name,
                                  int domain_id) {
  return {
      .domain_id = static_cast<uint32_t>(domain_id),
      .node_name = std::move(node_name),
      .node_namespace = settings.node_namespace,
      .gid_layout = settings.ros_distribution == "humble" ? GidLayout::kHumble : GidLayout::kIron};
}

}  // namespace palpate::dds
