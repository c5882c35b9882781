// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "libs/core/config_node.hpp"
#include "libs/dds/participant.hpp"

namespace palpate::dds {

/// Settings of the DDS side that all nodes share.
struct NodeSettings {
  std::filesystem::path topics_file;
  std::string node_namespace = "/";
  std::string ros_distribution = "humble";

  template <typename Visitor>
  void Visit(Visitor&& v) {
    v("topics_file", topics_file, "Topic table; empty: the built-in config/topics.yaml");
    v("node_namespace", node_namespace, "Namespace under which ROS 2 lists the node");
    v("ros_distribution", ros_distribution, {"humble", "iron"},
      "ROS 2 that shall see the node's name: humble, or iron for all later ones");
  }
};

/// Parses a text as settings; the second argument names it in messages.
using ConfigParser = std::function<ConfigNode(const std::string&, const std::string&)>;

/// The topic table that `settings` names. Throws InputError with file:line:column.
TopicTable LoadTopicTable(const NodeSettings& settings, const ConfigLoader& load,
                          const ConfigParser& parse);

ParticipantSettings ParticipantOf(const NodeSettings& settings, std::string node_name,
                                  int domain_id);

}  // namespace palpate::dds
