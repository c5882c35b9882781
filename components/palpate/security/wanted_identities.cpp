// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/security/wanted_identities.hpp"

#include <set>

#include "libs/core/error.hpp"
#include "libs/core/text.hpp"

namespace palpate::command {

namespace {

/// The value of "key=value" among the settings of a process, the last one; empty: not set.
std::string SettingOf(const ProcessPlan& process, const std::string& key) {
  std::string value;
  for (const std::string& setting : process.set) {
    if (setting.starts_with(key + "=")) value = setting.substr(key.size() + 1);
  }
  return value;
}

Identity IdentityOf(const ProcessPlan& process, const std::string& node_namespace) {
  Identity identity{
      .name = process.component, .role = process.component, .host = {}, .remap = process.remap};
  if (!node_namespace.empty()) identity.node_namespace = node_namespace;
  const std::string own_namespace = SettingOf(process, "dds.node_namespace");
  if (!own_namespace.empty()) identity.node_namespace = own_namespace;
  const std::string name = SettingOf(process, "dds.identity");
  if (!name.empty()) identity.name = name;
  const auto variable = process.environment.find("PALPATE_SECURITY_IDENTITY");
  if (name.empty() && variable != process.environment.end()) identity.name = variable->second;
  return identity;
}

}  // namespace

Identity ParseIdentity(const std::string& text) {
  Identity identity;
  std::string rest = text;
  const std::size_t at = rest.find('@');
  if (at != rest.npos) {
    identity.host = rest.substr(at + 1);
    rest.erase(at);
    if (identity.host.empty()) throw InputError("'" + Excerpt(text) + "': a host after '@'");
  }
  const std::size_t equals = rest.find('=');
  identity.name = rest.substr(0, equals);
  identity.role = equals == rest.npos ? identity.name : rest.substr(equals + 1);
  if (identity.name.empty() || identity.role.empty()) {
    throw InputError("'" + Excerpt(text) +
                     "' must be written as NAME[=ROLE][@HOST], like capture@camera_host");
  }
  return identity;
}

std::vector<Identity> IdentitiesOfSystem(const SystemFile& system) {
  std::vector<Identity> identities;
  std::set<std::string> names;
  for (const HostPlan& host : system.hosts) {
    for (const ProcessPlan& process : host.processes) {
      if (process.component.empty()) continue;  // another program
      Identity identity = IdentityOf(process, system.node_namespace);
      identity.host = host.name;
      if (!names.insert(identity.name).second) {
        throw InputError(process.where, "process '" + process.name +
                                            "' is a second process with the identity '" +
                                            identity.name +
                                            "': give it one of its own, set: {dds.identity: NAME}");
      }
      identities.push_back(identity);
    }
  }
  return identities;
}

}  // namespace palpate::command
