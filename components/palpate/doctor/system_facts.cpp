// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/doctor/system_facts.hpp"

#include <algorithm>
#include <string>
#include <vector>

namespace palpate::command {

SystemFacts FactsOf(const HostPlan& host) {
  SystemFacts facts;
  const auto runs = [&](const std::string& component) {
    return std::any_of(host.processes.begin(), host.processes.end(),
                       [&](const ProcessPlan& plan) { return plan.component == component; });
  };
  // A virtual camera is there once the system runs.
  facts.has_genicam_camera = runs("capture") && !runs("virtual_camera");
  for (const ProcessPlan& plan : host.processes) {
    if (plan.component == "capture") {
      const auto is_other = [](const std::string& setting) {
        return setting.starts_with("source=") && setting != "source=genicam";
      };
      if (std::any_of(plan.set.begin(), plan.set.end(), is_other)) facts.has_genicam_camera = false;
    }
    if (plan.component != "force_estimation") continue;
    const std::vector<std::string>& words = plan.arguments;
    if (!words.empty() && !words.front().starts_with('-')) facts.robot = words.front();
    const auto option = std::find(words.begin(), words.end(), "--calibration");
    if (option != words.end() && option + 1 != words.end()) facts.calibration = *(option + 1);
  }
  return facts;
}

}  // namespace palpate::command
