// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/node_settings.hpp"

#include <cstdlib>
#include <utility>

namespace palpate::dds {

namespace {

std::string Variable(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

std::string ComponentOf(const std::string& node_name) {
  constexpr std::string_view kPrefix = "palpate_";
  return node_name.starts_with(kPrefix) ? node_name.substr(kPrefix.size()) : node_name;
}

}  // namespace

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

SecuritySettings SecurityOf(const NodeSettings& settings, const std::string& default_identity) {
  SecuritySettings security{settings.security, settings.identity};
  if (security.keystore.empty()) security.keystore = Variable("PALPATE_SECURITY_DIR");
  if (security.keystore.empty() && Variable("ROS_SECURITY_ENABLE") == "true") {
    security.keystore = Variable("ROS_SECURITY_KEYSTORE");
  }
  if (security.identity.empty()) security.identity = Variable("PALPATE_SECURITY_IDENTITY");
  if (security.identity.empty()) security.identity = Variable("ROS_SECURITY_ENCLAVE_OVERRIDE");
  if (security.identity.starts_with('/')) security.identity.erase(0, 1);
  if (security.identity.empty()) security.identity = default_identity;
  return security;
}

ParticipantSettings ParticipantOf(const NodeSettings& settings, std::string node_name,
                                  int domain_id) {
  SecuritySettings security = SecurityOf(settings, ComponentOf(node_name));
  return {.domain_id = static_cast<uint32_t>(domain_id),
          .node_name = settings.node_name.empty() ? std::move(node_name) : settings.node_name,
          .node_namespace = settings.node_namespace,
          .gid_layout = GidLayoutOf(settings.ros_distribution, Variable("ROS_DISTRO")),
          .remap = settings.remap,
          .use_sim_time = settings.use_sim_time,
          .parameters = settings.parameters,
          .allow_faults = settings.allow_faults,
          .remote_raw = settings.remote_raw,
          .security = std::move(security)};
}

}  // namespace palpate::dds
