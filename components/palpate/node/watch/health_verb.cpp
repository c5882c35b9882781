// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/node/watch/health_verb.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>

#include "components/palpate/node/watch/system_listener.hpp"
#include "libs/app/node_options.hpp"
#include "libs/app/run_main.hpp"
#include "libs/app/stop_signal.hpp"
#include "libs/core/error.hpp"
#include "libs/core/text.hpp"

namespace palpate::command {

namespace {

ComponentHealth HealthOf(const monitor::ProcessState& process, bool any_status) {
  if (process.IsSilent()) {
    return {process.name, false, "silent",
            fmt::format("no report for {:.1f} s", process.silence_s)};
  }
  return {process.name, any_status || process.status == "ok", process.status, process.reason};
}

bool AllWell(const std::vector<ComponentHealth>& components) {
  return !components.empty() && std::all_of(components.begin(), components.end(),
                                            [](const auto& component) { return component.well; });
}

void PrintJson(int domain_id, const std::vector<ComponentHealth>& components) {
  auto list = nlohmann::ordered_json::array();
  for (const ComponentHealth& component : components) {
    list.push_back({{"name", component.name},
                    {"well", component.well},
                    {"status", component.state},
                    {"reason", component.reason}});
  }
  const nlohmann::ordered_json json = {
      {"domain", domain_id}, {"well", AllWell(components)}, {"components", list}};
  fmt::print("{}\n", json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

void PrintText(int domain_id, const std::vector<ComponentHealth>& components) {
  if (components.empty()) fmt::print("no palpate process in domain {}\n", domain_id);
  for (const ComponentHealth& component : components) {
    fmt::print("{}: {}{}{}\n", component.name, component.state,
               component.reason.empty() ? "" : ", ", component.reason);
  }
}

}  // namespace

std::vector<ComponentHealth> HealthOf(const monitor::SystemSnapshot& snapshot,
                                      const std::vector<std::string>& components, bool any_status) {
  std::vector<ComponentHealth> health;
  if (components.empty()) {
    for (const monitor::ProcessState& process : snapshot.processes) {
      health.push_back(HealthOf(process, any_status));
    }
  }
  for (std::string name : components) {
    std::replace(name.begin(), name.end(), '-', '_');
    const auto process = std::find_if(
        snapshot.processes.begin(), snapshot.processes.end(),
        [&](const monitor::ProcessState& candidate) { return candidate.name == name; });
    health.push_back(process != snapshot.processes.end()
                         ? HealthOf(*process, any_status)
                         : ComponentHealth{name, false, "no report", ""});
  }
  return health;
}

int Health(const HealthOptions& options) {
  if (options.timeout_s <= 0.0) {
    throw InputError("--timeout must be above 0 s, not " + FormatNumber(options.timeout_s));
  }
  SystemListener listener(options.domain_id, options.remap);
  const app::StopSignal stop;
  const auto health = [&] {
    return HealthOf(listener.Snapshot(), options.components, options.any_status);
  };
  const auto known = [&] {
    const bool complete = !options.components.empty() || listener.HeardAll();
    return stop.Requested() || (complete && AllWell(health()));
  };
  listener.Listen(known, std::chrono::duration<double>(options.timeout_s));
  const std::vector<ComponentHealth> components = health();
  if (options.json) {
    PrintJson(options.domain_id, components);
  } else {
    PrintText(options.domain_id, components);
  }
  return AllWell(components) ? app::kExitDone : app::kExitFailed;
}

app::Verb HealthVerb() {
  return {"health", "Tell whether components of the running system are well, by the exit code",
          [](app::Arguments& arguments) -> app::Verb::Action {
            const auto options = std::make_shared<HealthOptions>();
            arguments.Positionals("COMPONENT", &options->components,
                                  "Component, such as capture or force-estimation; without one "
                                  "all that are found",
                                  app::Need::kOptional);
            app::DeclareDomain(arguments, &options->domain_id);
            arguments.Repeated("--remap FROM:=TO", &options->remap,
                               "Another name for a topic, or __ns:=/left for all of a namespace");
            arguments.Option("--timeout S", &options->timeout_s,
                             "Longest wait until all are well, s");
            arguments.Flag("--any-status", &options->any_status,
                           "A component that reports is well, also where it waits for an input");
            arguments.Flag("--json", &options->json, "Print one JSON object");
            return [options] {
              app::SettleDomain(&options->domain_id);
              return Health(*options);
            };
          }};
}

}  // namespace palpate::command
