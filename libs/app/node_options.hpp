// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "libs/app/arguments.hpp"
#include "libs/app/ros_arguments.hpp"
#include "libs/app/settings.hpp"

namespace palpate::app {

/// The options that every process has: --config, --set, --domain, --log-level,
/// --print-config [--markdown], --remap, --security, beside what every program has
/// (command_text.hpp).
struct NodeOptions {
  std::filesystem::path config_file;  ///< empty: none
  std::string config_sha256;          ///< of that file's bytes; empty without a file
  std::vector<std::string> overrides;
  std::vector<std::string> remap;  ///< added to the setting dds.remap
  std::filesystem::path security;  ///< replaces the setting dds.security
  int domain_id = 0;               ///< --domain, else ROS_DOMAIN_ID, else 0; 0 to 232
  std::string log_level = "info";
  bool print_config = false;
  bool markdown = false;
};

/// --domain alone, for commands that join a domain but have no settings. Its value lands in
/// `domain_id` when the arguments are parsed, and SettleDomain() must follow.
void DeclareDomain(Arguments& arguments, int* domain_id);

/// Where --domain was not given: the domain of ROS_DOMAIN_ID, else 0. Throws InputError where
/// ROS_DOMAIN_ID is no domain.
void SettleDomain(int* domain_id);

/// --security alone, for the same commands. Its value lands in `keystore`; SettleSecurity() must
/// follow.
void DeclareSecurity(Arguments& arguments, std::filesystem::path* keystore);

/// Where --security was given: sets PALPATE_SECURITY_DIR of this process, and of those it starts.
void SettleSecurity(const std::filesystem::path& keystore);

/// Declares the options above; their values land in `options` when the arguments are parsed.
void DeclareNodeOptions(Arguments& arguments, NodeOptions* options);

/// After Parse(): settles the domain and fills the settings in the order defaults, file, --set.
/// False where --print-config was asked for and printed: the program is done.
/// Throws InputError for anything wrong in the environment, the file or an override.
bool SettleNodeOptions(const std::vector<Setting>& settings, NodeOptions* options);

/// What the command line of a process gives: its settings and the options above. Processes with
/// arguments of their own derive from it.
template <typename Config>
struct NodeCommand {
  Config config;
  NodeOptions options;
};

/// Reads the whole command line, that of ROS 2 (--ros-args) included, once a process has declared
/// the arguments of its own: declares the options above, parses, fills settings and options of
/// `command` (a NodeCommand). False: what was asked for has been printed, the program is done.
/// Throws InputError.
template <typename Command>
bool ReadNodeCommand(Arguments& arguments, int argc, const char* const* argv, Command* command) {
  DeclareNodeOptions(arguments, &command->options);
  return arguments.Parse(WithoutRosArguments(CommandLineWords(argc, argv))) &&
         SettleNodeOptions(ListSettings(command->config), &command->options);
}

}  // namespace palpate::app
