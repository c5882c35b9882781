// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <vector>

#include "libs/app/verbs.hpp"
#include "libs/monitor/system_snapshot.hpp"

namespace palpate::command {

struct HealthOptions {
  std::vector<std::string> components;  ///< "force_estimation" or "force-estimation"; empty: all
  int domain_id = 0;
  std::vector<std::string> remap;
  double timeout_s = 5.0;  ///< > 0
  bool any_status = false;
  bool json = false;
};

/// How one component is, as its last report says.
struct ComponentHealth {
  std::string name;
  bool well = false;
  std::string state;  ///< "ok", "no report", "silent", or the reported status
  std::string reason;
};

/// One entry for each of `components`, or, where these are empty, for each process that reported.
/// With `any_status` whoever reports is well.
std::vector<ComponentHealth> HealthOf(const monitor::SystemSnapshot& snapshot,
                                      const std::vector<std::string>& components, bool any_status);

/// Waits until all components are well, and prints a line for each. Returns the exit code: 1 where
/// one is not well within the time, or there is none. Throws InputError for a time that is none,
/// RunError where DDS refuses.
int Health(const HealthOptions& options);

app::Verb HealthVerb();

}  // namespace palpate::command
