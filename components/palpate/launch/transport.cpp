// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/launch/transport.hpp"

#include <filesystem>

#include "components/palpate/find_robot.hpp"
#include "libs/core/error.hpp"

namespace palpate::command {

namespace {

/// Of all hosts but this one, separated by commas.
std::string PeersOf(const SystemFile& system, const HostPlan& here) {
  std::string peers;
  const auto add = [&](const std::string& address) {
    if (!address.empty()) peers += (peers.empty() ? "" : ",") + address;
  };
  for (const HostPlan& host : system.hosts) {
    if (host.name != here.name) add(host.address);
  }
  for (const std::string& peer : system.peers) add(peer);
  return peers;
}

}  // namespace

std::map<std::string, std::string> MiddlewareEnvironment(const SystemFile& system,
                                                         const HostPlan& host) {
  std::map<std::string, std::string> environment;
  if (system.domain_id) environment["ROS_DOMAIN_ID"] = std::to_string(*system.domain_id);
  if (!system.transport.empty()) {
    const std::string name = "config/cyclonedds/" + system.transport + ".xml";
    const std::filesystem::path file = FindProjectFile(name);
    if (file.empty()) {
      throw InputError(SourceLocation{system.file.string()},
                       "transport '" + system.transport + "': " + name + " is not there");
    }
    environment["CYCLONEDDS_URI"] = "file://" + file.string();
  }
  const std::string interface =
      host.network_interface.empty() ? host.address : host.network_interface;
  if (system.transport != "one_host" && !interface.empty()) {
    environment["PALPATE_INTERFACE"] = interface;
  }
  const std::string peers = PeersOf(system, host);
  if (system.transport == "lossy_link" && !peers.empty()) environment["PALPATE_PEERS"] = peers;
  if (!system.security.empty()) {
    environment["PALPATE_SECURITY_DIR"] = std::filesystem::absolute(system.security).string();
  }
  return environment;
}

}  // namespace palpate::command
