// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/node/doctor/doctor_verb.hpp"

#include <fmt/core.h>

#include <cstdlib>
#include <memory>

#include "components/palpate/doctor/machine_facts.hpp"
#include "components/palpate/doctor/network_checks.hpp"
#include "components/palpate/doctor/system_facts.hpp"
#include "components/palpate/find_robot.hpp"
#include "components/palpate/node/doctor/domain_facts.hpp"
#include "components/palpate/node/live/terminal.hpp"
#include "libs/app/node_options.hpp"
#include "libs/app/run_main.hpp"
#include "libs/app/yaml.hpp"
#include "libs/core/error.hpp"
#include "libs/dds/domain_settings.hpp"
#include "libs/dds/host.hpp"

namespace palpate::command {

namespace {

SystemFacts ReadSystem(const DoctorOptions& options) {
  if (options.system.empty()) return {};
  std::filesystem::path file = options.system;
  if (!std::filesystem::exists(file)) {
    const auto known = FindProjectFile("config/systems/" + options.system + ".yaml");
    if (!known.empty()) file = known;
  }
  std::vector<std::string> own_names = {dds::ThisHost().name};
  for (const NetworkInterface& interface : NetworkInterfaces()) {
    if (interface.is_loopback) continue;
    own_names.insert(own_names.end(), interface.addresses.begin(), interface.addresses.end());
  }
  return ReadSystemFacts(app::LoadYaml(file), options.host, own_names);
}

/// The environment that `palpate launch` would give the processes of the system.
void ApplyTransport(const SystemFacts& system) {
  if (!system.network_interface.empty()) {
    setenv("PALPATE_INTERFACE", system.network_interface.c_str(), 1);
  }
  if (system.transport.empty()) return;
  const auto file = FindProjectFile("config/cyclonedds/" + system.transport + ".xml");
  setenv("CYCLONEDDS_URI", ("file://" + file.string()).c_str(), 1);
  std::string peers;
  for (const std::string& peer : system.peers) peers += (peers.empty() ? "" : ",") + peer;
  if (!peers.empty()) setenv("PALPATE_PEERS", peers.c_str(), 1);
}

void CheckNetwork(int domain_id, std::vector<Check>* checks) {
  const NetworkSettings network = ReadNetworkSettings(domain_id);
  checks->push_back(CheckReceiveBuffer(ReadReceiveBufferLimit_B()));
  checks->push_back(CheckSettings(network.transport));
  checks->push_back(CheckInterface(network.transport));
  checks->push_back(CheckDiscovery(network.discovery));
  const int used = CountUsedIndices(domain_id, network.most_index);
  const DomainMembers members = AskDomain(domain_id);
  const bool is_refused = !network.transport.refusal.empty();
  checks->push_back(CheckParticipants({.trouble = is_refused ? "not tried" : members.trouble,
                                       .are_numbered = network.are_indices_limited,
                                       .used = used,
                                       .limit = network.most_index}));
  if (is_refused || !members.trouble.empty()) return;
  checks->push_back(CheckVersions(members.peers, members.own_messages));
  checks->push_back(CheckClocks(members.clocks, members.other_hosts));
}

bool IsSecurityOn() {
  return dds::ProcessEnvironment("ROS_SECURITY_ENABLE").value_or("") == "true";
}

int Doctor(const DoctorOptions& options) {
  const std::vector<Check> checks = Diagnose(options);
  fmt::print("{}{}", options.json ? ChecksJson(checks) : ChecksText(checks, IsTerminal()),
             options.json ? "\n" : "");
  return Worst(checks) == Grade::kFailure ? app::kExitFailed : app::kExitDone;
}

}  // namespace

std::vector<Check> Diagnose(const DoctorOptions& options) {
  const SystemFacts system = ReadSystem(options);
  ApplyTransport(system);
  const int domain_id = system.domain_id.value_or(options.domain_id);
  const std::string trouble = system.domain_id ? std::string() : options.domain_trouble;
  std::vector<Check> checks = {CheckDomain({.trouble = trouble,
                                            .domain_id = domain_id,
                                            .first_ephemeral_port = ReadFirstEphemeralPort()})};
  if (trouble.empty()) CheckNetwork(domain_id, &checks);
  checks.push_back(CheckCameras(FindCameras(options.cameras, NetworkInterfaces()),
                                system.has_genicam_camera || !options.cameras.empty()));
  checks.push_back(CheckProcessor(ReadProcessor()));
  checks.push_back(CheckDisk(ReadDisk(std::filesystem::current_path())));
  const auto& security = options.security.empty() ? system.security : options.security;
  checks.push_back(CheckSecurity(ReadSecurity(security, !security.empty() || IsSecurityOn())));
  const auto& robot = options.robot.empty() ? system.robot : options.robot;
  const auto& calibration = options.calibration.empty() ? system.calibration : options.calibration;
  if (!robot.empty()) {
    checks.push_back(CheckRobotFiles(robot.string(), calibration.string(),
                                     CompareRobotFiles(robot, calibration)));
  }
  return checks;
}

app::Verb DoctorVerb() {
  return {"doctor", "Check this machine, its network and its files, and say how to fix them",
          [](app::Arguments& arguments) -> app::Verb::Action {
            const auto options = std::make_shared<DoctorOptions>();
            arguments.Positional("SYSTEM", &options->system,
                                 "System file of palpate launch, or the name of one in "
                                 "config/systems: check what its processes here need",
                                 app::Need::kOptional);
            arguments.Option("--host NAME", &options->host,
                             "Host of the system file that this machine is; without it the one "
                             "of its name or address");
            app::DeclareDomain(arguments, &options->domain_id);
            DeclareRobotOption(arguments, &options->robot, "Check that it can be read");
            arguments.Option("--calibration FILE", &options->calibration,
                             "Calibration file: check that it fits the robot file");
            arguments.Option("--security FOLDER", &options->security,
                             "Certificates and keys: check that they are valid and private");
            arguments.Repeated("--camera ADDRESS", &options->cameras,
                               "IPv4 address of a camera outside the local network");
            arguments.Flag("--json", &options->json, "Print JSON instead of text");
            return [options] {
              if (!options->calibration.empty() && options->robot.empty()) {
                throw InputError("--calibration needs --robot: give both");
              }
              try {
                app::SettleDomain(&options->domain_id);
              } catch (const InputError& error) {
                options->domain_trouble = error.what();
              }
              return Doctor(*options);
            };
          }};
}

}  // namespace palpate::command
