// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "components/player/node/node.hpp"
#include "components/player/node/recording_node.hpp"
#include "libs/app/node_options.hpp"

namespace palpate::player {

struct Command : app::NodeCommand<NodeConfig> {
  std::filesystem::path target;  ///< what `data` is, as an argument without a name
  std::filesystem::path data;    ///< experiment, recording folder, MCAP file or a folder of them
  double rate = 1.0;
  bool step = false;
  bool as_fast_as_possible = false;
  bool loop = false;
  // Of experiment folders.
  std::string recording;  ///< empty: all
  bool images = false;    ///< instead of markers
  // Of message files.
  std::vector<std::string> topics;
  std::vector<std::string> excluded;
  bool paused = false;
  double start_s = 0.0;
  double end_s = 0.0;       ///< 0: at the end
  double duration_s = 0.0;  ///< 0: to the end
  std::string step_topic;
  int step_count = 1;
  bool beside_writers = false;
  bool clock = false;
  bool json = false;

  std::vector<std::filesystem::path> message_files;  ///< that `data` names; empty: an experiment
};

/// Declares what `palpate-player` and `palpate play` have in common.
void DeclarePlay(app::Arguments& arguments, Command* command);

/// After parsing: checks the command. Throws InputError.
void SettlePlay(Command* command);

/// nullopt: --help, --version or --print-config was asked for and printed. Throws InputError.
std::optional<Command> ReadCommand(int argc, const char* const* argv);

/// Plays until the end or a signal; a recording with a line of its state, and keys on a terminal.
/// Returns the exit code. Throws InputError, RunError.
int Play(const Command& command);

}  // namespace palpate::player
