// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/launch/launch_verb.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "components/palpate/launch/launch_plan.hpp"
#include "components/palpate/launch/launcher.hpp"
#include "components/palpate/launch/prefixed_output.hpp"
#include "components/palpate/launch/signal_count.hpp"
#include "libs/app/notify.hpp"
#include "libs/app/run_main.hpp"
#include "libs/app/yaml.hpp"
#include "libs/core/error.hpp"
#include "libs/core/text.hpp"

namespace palpate::command {

namespace {

constexpr int kMaxDomain = 232;
constexpr int kDomainOfFile = -1;
constexpr double kTurn_s = 1.0;

SystemVariables ReadAssignments(const std::vector<std::string>& words) {
  SystemVariables variables;
  for (const std::string& word : words) {
    const std::size_t assign = word.find(":=");
    if (assign == std::string::npos || assign == 0) {
      throw InputError("'" + Excerpt(word) + "': variables are written as NAME:=VALUE");
    }
    variables[word.substr(0, assign)] = word.substr(assign + 2);
  }
  return variables;
}

void PrintPlanText(const SystemFile& system, const HostPlan& host,
                   const std::vector<LaunchedProcess>& processes) {
  fmt::print("# system {}, host {}\n", system.name, host.name);
  for (const LaunchedProcess& one : processes) {
    fmt::print("\n# {}{}{}\n", one.process.name, one.process.required ? ", required" : "",
               one.process.after.empty() ? "" : ", after " + Listed(one.process.after));
    for (const auto& [name, value] : one.command.environment) {
      fmt::print("{}={} \\\n", name, ShellWord(value));
    }
    fmt::print("{}\n", ShellLine(one.command));
  }
}

void PrintPlanJson(const SystemFile& system, const HostPlan& host,
                   const std::vector<LaunchedProcess>& processes) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const LaunchedProcess& one : processes) {
    list.push_back({{"name", one.process.name},
                    {"required", one.process.required},
                    {"after", one.process.after},
                    {"program", one.command.program.string()},
                    {"arguments", one.command.arguments},
                    {"environment", one.command.environment},
                    {"nice", one.command.nice}});
  }
  const nlohmann::ordered_json document = {
      {"system", system.name}, {"host", host.name}, {"processes", list}};
  fmt::print("{}\n", document.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
}

/// Until all have ended. Signals: the first stops, each further one hurries.
void RunUntilTheEnd(Launcher* launcher, LaunchOutput* output) {
  SignalCount signals;
  bool said_ready = false;
  while (launcher->Turn(kTurn_s, signals.file_descriptor())) {
    if (!said_ready && launcher->AllReady()) {
      said_ready = true;
      output->Event({}, Severity::kInfo, "all processes are ready");
      app::NotifyReady();
    }
    for (int count = signals.Take(); count > 0; --count) {
      if (!launcher->IsStopping()) {
        launcher->RequestStop("a signal (again: the next signal at once)");
      } else {
        launcher->Hurry();
      }
    }
  }
}

}  // namespace

int Launch(const LaunchOptions& options) {
  SystemFile system = ReadSystemFile(FindSystemFile(options.system), app::LoadYaml,
                                     ReadAssignments(options.variables));
  if (options.domain_id != kDomainOfFile) system.domain_id = options.domain_id;
  HostPlan& host = ChooseHost(system, options.host);
  for (const std::string& assignment : options.set) ApplySet(assignment, &host);
  const std::vector<LaunchedProcess> processes = MakeLaunchPlan(system, host);
  if (options.dry_run) {
    (options.json ? PrintPlanJson : PrintPlanText)(system, host, processes);
    return app::kExitDone;
  }
  std::vector<std::string> names;
  for (const LaunchedProcess& one : processes) names.push_back(one.process.name);
  std::FILE* const file = options.json ? stderr : stdout;
  PrefixedOutput output(names, file, isatty(fileno(file)) != 0);
  Launcher launcher(processes, system.stop, &output);
  RunUntilTheEnd(&launcher, &output);
  const int exit_code = launcher.RequiredFailed() ? app::kExitFailed : app::kExitDone;
  const std::vector<ProcessReport> reports = launcher.Reports();
  if (options.json) {
    fmt::print("{}\n", ReportJson(system.name, host.name, exit_code, reports));
  } else {
    fmt::print("\n{}", ReportText(reports));
  }
  return exit_code;
}

app::Verb LaunchVerb() {
  return {"launch", "Start the processes of a system file and keep them running",
          [](app::Arguments& arguments) -> app::Verb::Action {
            const auto options = std::make_shared<LaunchOptions>();
            arguments.Positional("SYSTEM", &options->system,
                                 "System file, or name of a system in config/systems");
            arguments.Suggest("SYSTEM", KnownSystems());
            arguments.Positionals("NAME:=VALUE", &options->variables,
                                  "Variables of the system file, as ros2 launch has it",
                                  app::Need::kOptional);
            arguments.Option("--host NAME", &options->host,
                             "Host of the file whose processes are started; without it the only "
                             "one, or the one that this computer is");
            arguments.Repeated("--set PROCESS.KEY=VALUE", &options->set,
                               "Change one setting of a process; overrides the system file");
            arguments.Option("--domain", &options->domain_id, 0, kMaxDomain,
                             "DDS domain; without it that of the system file, else of "
                             "ROS_DOMAIN_ID, else 0");
            arguments.Flag("--dry-run", &options->dry_run,
                           "Print environment and command line of each process and exit");
            arguments.Flag("--json", &options->json,
                           "Print the closing table, or the plan of --dry-run, as JSON; what the "
                           "processes write goes to the standard error output");
            return [options] { return Launch(*options); };
          }};
}

}  // namespace palpate::command
