// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "libs/core/config_node.hpp"
#include "libs/core/parameter.hpp"
#include "libs/dds/participant.hpp"

namespace palpate::dds {

/// Settings of the DDS side that all nodes share.
struct NodeSettings {
  std::filesystem::path topics_file;
  std::string node_name;
  std::string node_namespace = "/";
  std::vector<std::string> remap;
  bool use_sim_time = false;
  std::string ros_distribution = "auto";
  std::vector<Parameter> parameters = {};  ///< all settings of the process, to be shown to ROS 2
  bool remote_raw = true;
  bool allow_faults = false;
  std::filesystem::path security;
  std::string identity;

  template <typename Visitor>
  void Visit(Visitor&& v) {
    v("topics_file", topics_file, "Topic table; empty: the built-in config/topics.yaml");
    v("node_name", node_name, "Name under which ROS 2 lists the node; empty: the program's");
    v("node_namespace", node_namespace,
      "Namespace of the node and its topics, except /rosout, /diagnostics, /tf_static and /clock");
    v("remap", remap, "Other names of topics as \"/a:=/b\", as ROS 2 has it; same as --remap");
    v("use_sim_time", use_sim_time, "Take the time from /clock instead of the system clock");
    v("ros_distribution", ros_distribution, {"auto", "humble", "iron"},
      "ROS 2 that shall see the node's name: humble, or iron for all later ones; auto: by the "
      "environment variable ROS_DISTRO, else humble");
    v("remote_raw", remote_raw,
      "Share raw images with other hosts and with ROS 2; false: with processes of this host that "
      "have false, too");
    v("allow_faults", allow_faults,
      "Let `palpate fail` make the data of this process faulty, for tests of a system");
    v("security", security,
      "Keystore (`palpate security init`) of a secured domain; empty: the environment variable "
      "PALPATE_SECURITY_DIR, else ROS 2's, else the domain is not secured");
    v("identity", identity,
      "Who this process is in a secured domain; empty: PALPATE_SECURITY_IDENTITY, else ROS 2's "
      "enclave, else the component's name");
  }
};

/// Settings of a process: those of its component, and those of its DDS side.
template <typename Config>
struct WithNodeSettings : Config {
  NodeSettings dds;

  template <typename Visitor>
  void Visit(Visitor&& v) {
    Config::Visit(v);
    v("dds", dds, "DDS side");
  }
};

/// Parses a text as settings; the second argument names it in messages.
using ConfigParser = std::function<ConfigNode(const std::string&, const std::string&)>;

/// The topic table that `settings` names. Throws InputError with file:line:column.
TopicTable LoadTopicTable(const NodeSettings& settings, const ConfigLoader& load,
                          const ConfigParser& parse);

/// How the ROS 2 of that setting writes identifiers; `ros_distro`: of the environment, may be
/// empty.
GidLayout GidLayoutOf(std::string_view ros_distribution, std::string_view ros_distro);

/// The keystore of the settings, else of PALPATE_SECURITY_DIR, else, where ROS_SECURITY_ENABLE is
/// "true", of ROS_SECURITY_KEYSTORE. The identity of the settings, else of
/// PALPATE_SECURITY_IDENTITY, else of ROS_SECURITY_ENCLAVE_OVERRIDE, else `default_identity`.
SecuritySettings SecurityOf(const NodeSettings& settings, const std::string& default_identity);

/// `node_name` holds unless the settings have another. The default identity is the node's name
/// without "palpate_".
ParticipantSettings ParticipantOf(const NodeSettings& settings, std::string node_name,
                                  int domain_id);

}  // namespace palpate::dds
