// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "libs/app/arguments.hpp"
#include "libs/app/settings.hpp"

namespace palpate::app {

/// The options that every process has: --config, --set, --domain, --log-level,
/// --print-config [--markdown], beside what every program has (command_text.hpp).
struct NodeOptions {
  std::filesystem::path config_file;  ///< empty: none
  std::string config_sha256;          ///< of that file's bytes; empty without a file
  std::vector<std::string> overrides;
  int domain_id = 0;  ///< --domain, else ROS_DOMAIN_ID, else 0; 0 to 232
  std::string log_level = "info";
  bool print_config = false;
  bool markdown = false;
};

/// Declares the options above; their values land in `options` when the arguments are parsed.
void DeclareNodeOptions(Arguments& arguments, NodeOptions* options);

/// After Parse(): settles the domain and fills the settings in the order defaults, file, --set.
/// False where --print-config was asked for and printed: the program is done.
/// Throws InputError for anything wrong in the environment, the file or an override.
bool SettleNodeOptions(const std::vector<Setting>& settings, NodeOptions* options);

/// All of it for a process without arguments of its own. False: nothing is to be done.
///
///   int main(int argc, char** argv) {
///     return palpate::app::RunMain("palpate-player", [&] {
///       player::Config config;
///       app::NodeOptions options;
///       if (!app::ReadCommandLine("palpate-player", "Plays ...", argc, argv, config, &options)) {
///         return app::kExitDone;
///       }
///       app::StopSignal stop;
///       app::StartLog("palpate-player", options);
///       ...
template <typename Config>
bool ReadCommandLine(const std::string& program, const std::string& purpose, int argc,
                     const char* const* argv, Config& config, NodeOptions* options) {
  Arguments arguments(program, purpose);
  DeclareNodeOptions(arguments, options);
  return arguments.Parse(CommandLineWords(argc, argv)) &&
         SettleNodeOptions(ListSettings(config), options);
}

}  // namespace palpate::app
