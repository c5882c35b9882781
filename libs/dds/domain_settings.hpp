// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "libs/core/error.hpp"
#include "libs/core/network_interfaces.hpp"

namespace palpate::dds {

/// A network interface that the settings of Cyclone DDS name.
struct ChosenInterface {
  std::string name;
  std::string address;
  bool automatic = false;  ///< Cyclone DDS chooses
  SourceLocation where;
};

/// What decides about the network in the settings of Cyclone DDS.
struct DomainSettings {
  std::vector<ChosenInterface> interfaces;  ///< empty: Cyclone DDS chooses one
  std::string allow_multicast = "default";
  std::optional<std::int64_t> max_message_B;
  SourceLocation max_message_where;
  std::vector<std::string> peers;
  std::string participant_index = "default";
  int max_participant_index = 9;
  bool shared_memory = false;
  SourceLocation shared_memory_where;
  bool security = false;  ///< in the settings, or by ROS_SECURITY_ENABLE
  SourceLocation security_where;
  std::vector<std::string> missing_files;

  bool UsesMulticast() const { return allow_multicast != "false"; }
};

/// A variable of the environment; nullopt where it is not set.
using Environment = std::function<std::optional<std::string>(const std::string&)>;
std::optional<std::string> ProcessEnvironment(const std::string& name);

/// `text` with ${X}, ${X:-default} and ${X:+other} replaced, as Cyclone DDS does.
std::string ExpandVariables(std::string_view text, const Environment& environment);

/// Reads `uri`, the value of CYCLONEDDS_URI: files and XML, separated by commas, later ones win.
/// Files that cannot be read and text that is no XML are left to Cyclone DDS, which refuses them.
DomainSettings ReadDomainSettings(const std::string& uri, std::uint32_t domain_id,
                                  const Environment& environment = ProcessEnvironment);

/// Whether messages leave this host by one of the interfaces that are up.
bool LeavesHost(const DomainSettings& settings, const std::vector<NetworkInterface>& interfaces);

/// Why a process must not start with these settings, "file:line: cause; remedy"; empty: it may.
std::string RefusalOf(const DomainSettings& settings,
                      const std::vector<NetworkInterface>& interfaces);

}  // namespace palpate::dds
