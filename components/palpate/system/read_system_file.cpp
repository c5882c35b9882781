// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <arpa/inet.h>

#include <algorithm>
#include <set>

#include "components/palpate/system/system_file.hpp"
#include "components/palpate/system/system_file_keys.hpp"
#include "components/palpate/system/variables.hpp"
#include "libs/core/config_reader.hpp"
#include "libs/core/names.hpp"
#include "libs/core/text.hpp"

namespace palpate::command {

namespace {

const std::vector<ConfigNode>& Items(const ConfigNode& node) {
  if (node.kind != ConfigNode::Kind::kList) Refuse(node, "must be a list");
  return node.items;
}

/// Any scalar, as it is written.
std::string ReadWord(const ConfigNode& node) {
  if (node.kind != ConfigNode::Kind::kScalar) Refuse(node, "must be a text or a number");
  return node.text;
}

std::vector<std::string> ReadWords(const ConfigNode* node) {
  std::vector<std::string> words;
  if (node == nullptr) return words;
  for (const ConfigNode& item : Items(*node)) words.push_back(ReadWord(item));
  return words;
}

/// A value as --set takes it.
std::string ValueText(const ConfigNode& node) {
  if (node.kind == ConfigNode::Kind::kScalar) return node.quoted ? Quoted(node.text) : node.text;
  if (node.kind == ConfigNode::Kind::kNull) return "~";
  std::string text;
  for (const ConfigNode& item : Items(node)) text += (text.empty() ? "" : ", ") + ValueText(item);
  return "[" + text + "]";
}

void RequireMap(const ConfigNode& node) {
  if (node.kind != ConfigNode::Kind::kMap) Refuse(node, "must be a map");
}

std::vector<std::string> ReadSet(const ConfigNode* node) {
  std::vector<std::string> set;
  if (node == nullptr) return set;
  RequireMap(*node);
  for (const auto& [key, value] : node->entries) set.push_back(key + "=" + ValueText(value));
  return set;
}

std::map<std::string, std::string> ReadEnvironment(const ConfigNode* node) {
  std::map<std::string, std::string> environment;
  if (node == nullptr) return environment;
  RequireMap(*node);
  for (const auto& [key, value] : node->entries) {
    if (key == "NOTIFY_SOCKET") Refuse(value, "is set by palpate launch");
    environment[key] = ReadWord(value);
  }
  return environment;
}

RespawnPlan ReadRespawn(const ConfigNode& node) {
  MapReader reader(node, RespawnKeys());
  RespawnPlan plan;
  std::string when = "failure";
  reader.Read("when", &when);
  plan.always = when == "always";
  reader.Read("limit", &plan.limit);
  reader.Read("backoff_s", &plan.backoff_s);
  reader.Read("longest_backoff_s", &plan.longest_backoff_s);
  reader.Read("reset_after_s", &plan.reset_after_s);
  reader.Finish();
  if (plan.longest_backoff_s < plan.backoff_s) {
    Refuse(node, "longest_backoff_s (" + FormatNumber(plan.longest_backoff_s) +
                     ") must not be below backoff_s (" + FormatNumber(plan.backoff_s) + ")");
  }
  return plan;
}

StopPlan ReadStop(const ConfigNode& node) {
  MapReader reader(node, StopKeys());
  StopPlan plan;
  reader.Read("interrupt_s", &plan.interrupt_s);
  reader.Read("terminate_s", &plan.terminate_s);
  reader.Finish();
  return plan;
}

/// Names are prefixes of lines and parts of --set.
std::string ReadName(MapReader& reader) {
  std::string name;
  reader.Read("name", &name);
  const auto allowed = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '-'; };
  if (name.empty() || !std::all_of(name.begin(), name.end(), allowed)) {
    Refuse(reader.Require("name"),
           "must be of letters, digits, '_' and '-', not '" + Excerpt(name) + "'");
  }
  return name;
}

void ReadWhatRuns(const ConfigNode& node, MapReader& reader, ProcessPlan* plan) {
  reader.Read("component", &plan->component);
  reader.Read("program", &plan->program);
  if (plan->component.empty() == plan->program.empty()) {
    Refuse(node, "exactly one of 'component' and 'program' must be there");
  }
  plan->notifies = !plan->component.empty();
  std::string ready;
  reader.Read("ready", &ready);
  if (!ready.empty()) plan->notifies = ready == "notify";
  if (plan->component.empty()) {
    for (const char* key : {"settings", "set", "remap"}) {
      if (const ConfigNode* entry = reader.Optional(key)) {
        Refuse(*entry, "is of components alone: give 'arguments' to a program");
      }
    }
  }
}

ProcessPlan ReadProcess(const ConfigNode& node) {
  MapReader reader(node, ProcessKeys());
  ProcessPlan plan;
  plan.where = node.where;
  plan.name = ReadName(reader);
  ReadWhatRuns(node, reader, &plan);
  reader.Read("settings", &plan.settings);
  plan.set = ReadSet(reader.Optional("set"));
  plan.remap = ReadWords(reader.Optional("remap"));
  plan.arguments = ReadWords(reader.Optional("arguments"));
  plan.environment = ReadEnvironment(reader.Optional("environment"));
  plan.after = ReadWords(reader.Optional("after"));
  reader.Read("required", &plan.required);
  if (const ConfigNode* respawn = reader.Optional("respawn")) plan.respawn = ReadRespawn(*respawn);
  reader.Read("ready_timeout_s", &plan.ready_timeout_s);
  reader.Read("nice", &plan.nice);
  reader.Finish();
  return plan;
}

/// Throws where `after` names a process that is not there, or leads back to itself.
void CheckOrder(const HostPlan& host) {
  std::vector<std::string> names;
  for (const ProcessPlan& plan : host.processes) names.push_back(plan.name);
  for (const ProcessPlan& plan : host.processes) {
    for (const std::string& name : plan.after) {
      if (IndexOf(name, names)) continue;
      throw InputError(plan.where, "process '" + plan.name + "': 'after' names an " +
                                       Unknown("process", name, names) + " of host '" + host.name +
                                       "'");
    }
  }
  std::set<std::string> free;  // of a circle
  for (bool grew = true; grew;) {
    grew = false;
    for (const ProcessPlan& plan : host.processes) {
      const bool can_start = std::all_of(plan.after.begin(), plan.after.end(),
                                         [&](const auto& name) { return free.contains(name); });
      if (can_start) grew = free.insert(plan.name).second || grew;
    }
  }
  for (const ProcessPlan& plan : host.processes) {
    if (free.contains(plan.name)) continue;
    throw InputError(plan.where,
                     "process '" + plan.name + "' never starts: 'after' leads in a circle");
  }
}

void CheckAddress(const ConfigNode& node, const std::string& address) {
  in_addr parsed{};
  if (inet_pton(AF_INET, address.c_str(), &parsed) != 1) {
    Refuse(node, "must be an IPv4 address as 192.168.1.10, not '" + Excerpt(address) + "'");
  }
}

HostPlan ReadHost(const ConfigNode& node) {
  MapReader reader(node, HostKeys());
  HostPlan plan;
  plan.where = node.where;
  plan.name = ReadName(reader);
  reader.Read("address", &plan.address);
  if (!plan.address.empty()) CheckAddress(reader.Require("address"), plan.address);
  reader.Read("interface", &plan.network_interface);
  for (const ConfigNode& process : Items(reader.Require("processes"))) {
    plan.processes.push_back(ReadProcess(process));
  }
  reader.Finish();
  if (plan.processes.empty()) Refuse(*node.Find("processes"), "must not be empty");
  CheckOrder(plan);
  return plan;
}

std::vector<HostPlan> ReadHosts(const ConfigNode& node) {
  std::vector<HostPlan> hosts;
  std::set<std::string> host_names;
  std::set<std::string> process_names;
  for (const ConfigNode& item : Items(node)) {
    hosts.push_back(ReadHost(item));
    if (!host_names.insert(hosts.back().name).second) {
      Refuse(item, "the name '" + hosts.back().name + "' is given to two hosts");
    }
    for (const ProcessPlan& plan : hosts.back().processes) {
      if (process_names.insert(plan.name).second) continue;
      throw InputError(plan.where, "the name '" + plan.name + "' is given to two processes");
    }
  }
  if (hosts.empty()) Refuse(node, "must not be empty");
  return hosts;
}

void CheckTransport(const ConfigNode& root, const SystemFile& system) {
  const ConfigNode* transport = root.Find("transport");
  if (system.transport == "one_host" && system.hosts.size() > 1) {
    Refuse(*transport, "'one_host' stays on loopback, and the file has " +
                           std::to_string(system.hosts.size()) +
                           " hosts: write lan, jumbo_lan "
                           "or lossy_link");
  }
  if (system.transport != "lossy_link") return;
  for (const HostPlan& host : system.hosts) {
    if (!host.address.empty()) continue;
    throw InputError(host.where, "host '" + host.name +
                                     "': 'address' is missing; transport lossy_link has no "
                                     "multicast that finds it");
  }
}

}  // namespace

SystemFile ReadSystemFile(const std::filesystem::path& file, const ConfigLoader& load,
                          const SystemVariables& variables) {
  ConfigNode root = load(file);
  SubstituteVariables(&root, variables);
  MapReader reader(root, SystemFileKeys());
  SystemFile system;
  system.file = file;
  system.name = ReadName(reader);
  if (reader.Optional("domain") != nullptr) {
    int domain_id = 0;
    reader.Read("domain", &domain_id);
    system.domain_id = domain_id;
  }
  reader.Read("namespace", &system.node_namespace);
  reader.Read("transport", &system.transport);
  if (const ConfigNode* peers = reader.Optional("peers")) {
    system.peers = ReadWords(peers);
    for (const ConfigNode& peer : peers->items) CheckAddress(peer, peer.text);
  }
  reader.Read("security", &system.security);
  reader.Read("allow_faults", &system.allow_faults);
  if (const ConfigNode* stop = reader.Optional("stop")) system.stop = ReadStop(*stop);
  reader.Optional("variables");
  system.hosts = ReadHosts(reader.Require("hosts"));
  reader.Finish();
  CheckTransport(root, system);
  return system;
}

ProcessPlan& FindProcess(HostPlan& host, const std::string& name) {
  std::vector<std::string> names;
  for (ProcessPlan& plan : host.processes) {
    if (plan.name == name) return plan;
    names.push_back(plan.name);
  }
  throw InputError(Unknown("process", name, names) + " of host '" + host.name + "'");
}

}  // namespace palpate::command
