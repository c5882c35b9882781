// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "libs/core/config_node.hpp"

namespace palpate::command {

/// When and how often a process is started again.
struct RespawnPlan {
  bool always = false;  ///< also after exit code 0
  int limit = 5;        ///< restarts in a row
  double backoff_s = 1.0;
  double longest_backoff_s = 30.0;
  double reset_after_s = 60.0;  ///< a run this long ends the row
};

/// How long a process may take to end before the next signal: SIGINT, SIGTERM, SIGKILL.
struct StopPlan {
  double interrupt_s = 5.0;
  double terminate_s = 5.0;
};

struct ProcessPlan {
  SourceLocation where;
  std::string name;
  std::string component;           ///< "force_estimation"; empty: `program`
  std::string program;             ///< a path, or a name in PATH; empty: `component`
  std::filesystem::path settings;  ///< empty: none
  std::vector<std::string> set;    ///< "key=value", as --set takes it
  std::vector<std::string> remap;  ///< "/from:=/to"
  std::vector<std::string> arguments;
  std::map<std::string, std::string> environment;
  std::vector<std::string> after;  ///< names of processes of the same host
  bool required = false;
  std::optional<RespawnPlan> respawn;  ///< nullopt: not started again
  bool notifies = true;                ///< says itself when it is ready
  double ready_timeout_s = 60.0;
  int nice = 0;
};

struct HostPlan {
  SourceLocation where;
  std::string name;
  std::string address;            ///< empty: not known
  std::string network_interface;  ///< empty: the middleware chooses
  std::vector<ProcessPlan> processes;
};

/// The processes of a system, and the hosts on which they run.
struct SystemFile {
  std::filesystem::path file;
  std::string name;
  std::optional<int> domain_id;    ///< nullopt: ROS_DOMAIN_ID, else 0
  std::string node_namespace;      ///< "/left"; empty: none
  std::string transport;           ///< TransportNames(); empty: CYCLONEDDS_URI, else the default
  std::vector<std::string> peers;  ///< addresses of hosts outside this file
  std::filesystem::path security;  ///< empty: none
  bool allow_faults = false;       ///< `palpate fail` may act on the components
  StopPlan stop;
  std::vector<HostPlan> hosts;
};

/// Values of variables of a system file, by name.
using SystemVariables = std::map<std::string, std::string>;

/// Reads a system file. `variables` replace those of the file. Throws InputError (file:line:column,
/// key, value, rule) for anything that the file may not hold, and for unknown variables.
SystemFile ReadSystemFile(const std::filesystem::path& file, const ConfigLoader& load,
                          const SystemVariables& variables = {});

/// The process of that name; throws InputError with "did you mean".
ProcessPlan& FindProcess(HostPlan& host, const std::string& name);

}  // namespace palpate::command
