// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/node_settings.hpp"

#include <cstdlib>
#include <utility>

namespace palpate::dds {

TopicTable LoadTopicTable(const NodeSettings& settings, const ConfigLoader& load,
                          const ConfigParser& parse) {
  return ReadTopicTable(settings.topics_file.empty()
                            ? parse(std::string(BuiltInTopicsYaml()), "config/topics.yaml")
                            : load(settings.topics_file));
}

GidLayout GidLayoutOf(std::string_view ros_distribution, std::string_view ros_distro) {
  if (ros_distribution == "auto") ros_distribution = ros_distro;
  const bool old = ros_distribution.empty() || ros_distribution == "foxy" ||
                   ros_distribution == "galactic" || ros_distribution == "humble";
  return old ? GidLayout::kHumble : GidLayout::kIron;
}

ParticipantSettings ParticipantOf(const NodeSettings& settings, std::string node_name,
                                  int domain_id) {
  const char* ros_distro = std::getenv("ROS_DISTRO");
  return {
      .domain_id = static_cast<uint32_t>(domain_id),
      .node_name = settings.node_name.empty() ? std::move(node_name) : settings.node_name,
      .node_namespace = settings.node_namespace,
      .gid_layout = GidLayoutOf(settings.ros_distribution, ros_distro == nullptr ? "" : ros_distro),
      .remap = settings.remap,
      .use_sim_time = settings.use_sim_time,
      .parameters = settings.parameters,
      .remote_raw = settings.remote_raw};
}

}  // namespace palpate::dds
