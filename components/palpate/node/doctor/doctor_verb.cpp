// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/node/doctor/doctor_verb.hpp"

#include <fmt/core.h>

#include <cstdlib>
#include <memory>
#include <optional>

#include "components/palpate/doctor/machine_facts.hpp"
#include "components/palpate/doctor/network_checks.hpp"
#include "components/palpate/doctor/system_facts.hpp"
#include "components/palpate/find_robot.hpp"
#include "components/palpate/launch/launch_plan.hpp"
#include "components/palpate/launch/transport.hpp"
#include "components/palpate/node/doctor/domain_facts.hpp"
#include "components/palpate/node/live/terminal.hpp"
#include "libs/app/node_options.hpp"
#include "libs/app/run_main.hpp"
#include "libs/app/yaml.hpp"
#include "libs/core/error.hpp"
#include "libs/dds/domain_settings.hpp"

namespace palpate::command {

namespace {

/// What a system file says about this host.
struct HostNeeds {
  std::optional<int> domain_id;
  std::filesystem::path security;  ///< empty: none
  SystemFacts facts;
};

/// Gives this process the environment that `palpate launch` would give those of the system.
HostNeeds EnterSystem(const DoctorOptions& options) {
  if (options.system.empty()) return {};
  SystemFile system = ReadSystemFile(FindSystemFile(options.system), app::LoadYaml);
  const HostPlan& host = ChooseHost(system, options.host);
  for (const auto& [name, value] : MiddlewareEnvironment(system, host)) {
    setenv(name.c_str(), value.c_str(), 1);
  }
  return {.domain_id = system.domain_id, .security = system.security, .facts = FactsOf(host)};
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
  const HostNeeds system = EnterSystem(options);
  const int domain_id = system.domain_id.value_or(options.domain_id);
  const std::string trouble = system.domain_id ? std::string() : options.domain_trouble;
  std::vector<Check> checks = {CheckDomain({.trouble = trouble,
                                            .domain_id = domain_id,
                                            .first_ephemeral_port = ReadFirstEphemeralPort()})};
  if (trouble.empty()) CheckNetwork(domain_id, &checks);
  checks.push_back(CheckCameras(FindCameras(options.cameras, NetworkInterfaces()),
                                system.facts.has_genicam_camera || !options.cameras.empty()));
  checks.push_back(CheckProcessor(ReadProcessor()));
  checks.push_back(CheckDisk(ReadDisk(std::filesystem::current_path())));
  const auto& security = options.security.empty() ? system.security : options.security;
  checks.push_back(CheckSecurity(ReadSecurity(security, !security.empty() || IsSecurityOn())));
  const auto& robot = options.robot.empty() ? system.facts.robot : options.robot;
  const auto& calibration =
      options.calibration.empty() ? system.facts.calibration : options.calibration;
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
