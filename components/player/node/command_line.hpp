// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "components/player/node/node.hpp"
#include "libs/app/node_options.hpp"

namespace palpate::player {

struct Command : app::NodeCommand<NodeConfig> {
  Playback playback;
  std::filesystem::path data;
  std::string recording;  ///< empty: all
  bool images = false;    ///< instead of markers
};

/// nullopt: --help, --version or --print-config was asked for and printed. Throws InputError.
std::optional<Command> ReadCommand(int argc, const char* const* argv);

/// Reads the experiment of the command. Throws InputError, RunError.
std::unique_ptr<PlayerNode> MakeNode(const Command& command);

}  // namespace palpate::player
