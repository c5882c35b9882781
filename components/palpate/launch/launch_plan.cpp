// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/launch/launch_plan.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <set>
#include <utility>

#include "components/palpate/find_robot.hpp"
#include "components/palpate/launch/transport.hpp"
#include "libs/core/error.hpp"
#include "libs/core/names.hpp"
#include "libs/core/network_interfaces.hpp"

namespace palpate::command {

namespace {

std::string NameOfComputer() {
  std::array<char, 256> name{};
  gethostname(name.data(), name.size() - 1);
  const std::string whole = name.data();
  return whole.substr(0, whole.find('.'));
}

std::set<std::string> AddressesOfComputer() {
  std::set<std::string> addresses;
  for (const NetworkInterface& interface : NetworkInterfaces()) {
    addresses.insert(interface.addresses.begin(), interface.addresses.end());
  }
  return addresses;
}

std::filesystem::path ProgramOf(const ProcessPlan& plan) {
  if (plan.component.empty()) {
    const std::filesystem::path program = FindExecutable(plan.program);
    if (!program.empty()) return program;
    throw InputError(plan.where, "process '" + plan.name + "': no program '" + plan.program +
                                     "' (a path, or a name in PATH)");
  }
  std::string name = "palpate-" + plan.component;
  std::replace(name.begin(), name.end(), '_', '-');
  const std::filesystem::path program = FindExecutable((ProgramFolder() / name).string());
  if (!program.empty()) return program;
  throw InputError(plan.where, "process '" + plan.name + "': " + name + " is not in " +
                                   ProgramFolder().string());
}

std::vector<std::string> ArgumentsOf(const SystemFile& system, const ProcessPlan& plan) {
  std::vector<std::string> words = plan.arguments;
  if (plan.component.empty()) return words;
  const auto add = [&](const char* option, const std::string& value) {
    words.insert(words.end(), {option, value});
  };
  if (!plan.settings.empty()) {
    std::error_code none;
    if (!std::filesystem::exists(plan.settings, none)) {
      throw InputError(plan.where,
                       "process '" + plan.name + "': no settings file " + plan.settings.string());
    }
    add("--config", plan.settings.string());
  }
  if (system.allow_faults) add("--set", "dds.allow_faults=true");
  for (const std::string& assignment : plan.set) add("--set", assignment);
  if (!system.node_namespace.empty()) add("--remap", "__ns:=" + system.node_namespace);
  for (const std::string& rule : plan.remap) add("--remap", rule);
  if (system.domain_id) add("--domain", std::to_string(*system.domain_id));
  return words;
}

LaunchedProcess Prepare(const SystemFile& system, const HostPlan& host, const ProcessPlan& plan) {
  LaunchedProcess launched;
  launched.process.name = plan.name;
  launched.process.after = plan.after;
  launched.process.required = plan.required;
  launched.process.rules = {.notifies = plan.notifies,
                            .ready_timeout_s = plan.ready_timeout_s,
                            .respawn = plan.respawn,
                            .stop = system.stop,
                            .exit_2_is_final = !plan.component.empty()};
  launched.command.program = ProgramOf(plan);
  launched.command.arguments = ArgumentsOf(system, plan);
  launched.command.environment = MiddlewareEnvironment(system, host);
  for (const auto& [name, value] : plan.environment) launched.command.environment[name] = value;
  launched.command.nice = plan.nice;
  return launched;
}

}  // namespace

std::vector<std::string> KnownSystems() {
  std::vector<std::string> names;
  std::error_code none;
  for (const auto& entry :
       std::filesystem::directory_iterator(FindProjectFile("config/systems"), none)) {
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::filesystem::path FindSystemFile(const std::filesystem::path& system) {
  std::error_code none;
  if (std::filesystem::is_regular_file(system, none)) return system;
  const std::string text = system.string();
  const bool is_name = !text.empty() && !system.has_extension() && !system.has_parent_path();
  if (!is_name) throw InputError("no system file '" + text + "'");
  const auto named = FindProjectFile("config/systems/" + text + ".yaml");
  if (!named.empty()) return named;
  throw InputError("no system file '" + text + "', nor a system of that name" +
                   DidYouMean(text, KnownSystems()));
}

HostPlan& ChooseHost(SystemFile& system, const std::string& name) {
  std::vector<std::string> names;
  for (const HostPlan& host : system.hosts) names.push_back(host.name);
  if (!name.empty()) {
    const auto index = IndexOf(name, names);
    if (index) return system.hosts[*index];
    throw InputError("--host: " + Unknown("host", name, names) + "; " + system.file.string() +
                     " has " + Listed(names));
  }
  if (system.hosts.size() == 1) return system.hosts.front();
  const std::string own_name = NameOfComputer();
  const std::set<std::string> own_addresses = AddressesOfComputer();
  std::vector<std::size_t> fitting;
  for (std::size_t i = 0; i < system.hosts.size(); ++i) {
    const HostPlan& host = system.hosts[i];
    if (host.name == own_name || own_addresses.contains(host.address)) fitting.push_back(i);
  }
  if (fitting.size() == 1) return system.hosts[fitting.front()];
  throw InputError("--host is required: this computer ('" + own_name + "') is " +
                   (fitting.empty() ? "none" : "more than one") + " of the hosts " + Listed(names) +
                   " of " + system.file.string());
}

std::vector<LaunchedProcess> MakeLaunchPlan(const SystemFile& system, const HostPlan& host) {
  std::vector<LaunchedProcess> processes;
  for (const ProcessPlan& plan : host.processes) processes.push_back(Prepare(system, host, plan));
  return processes;
}

void ApplySet(const std::string& assignment, HostPlan* host) {
  const std::size_t dot = assignment.find('.');
  const std::size_t equals = assignment.find('=');
  if (dot == 0 || equals == std::string::npos || dot >= equals) {
    throw InputError("--set " + Excerpt(assignment) + ": must be written as PROCESS.KEY=VALUE");
  }
  ProcessPlan& plan = FindProcess(*host, assignment.substr(0, dot));
  if (plan.component.empty()) {
    throw InputError("--set " + Excerpt(assignment) + ": process '" + plan.name +
                     "' is no component and has no settings");
  }
  plan.set.push_back(assignment.substr(dot + 1));
}

std::string ShellWord(const std::string& word) {
  const auto plain = [](unsigned char c) {
    return std::isalnum(c) != 0 ||
           std::string_view("_-./:=,+@%").find(static_cast<char>(c)) != std::string_view::npos;
  };
  if (!word.empty() && std::all_of(word.begin(), word.end(), plain)) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

std::string ShellLine(const ChildCommand& command) {
  std::string line = ShellWord(command.program.string());
  for (const std::string& word : command.arguments) line += " " + ShellWord(word);
  return line;
}

}  // namespace palpate::command
