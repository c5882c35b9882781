// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "components/recorder/node/node.hpp"
#include "libs/app/node_options.hpp"

namespace palpate::recorder {

struct Command : app::NodeCommand<NodeConfig> {
  std::filesystem::path out;
  std::vector<std::string> topics;
  std::vector<std::string> excluded;
  bool only_recent = false;
  double duration_s = 0.0;
  bool json = false;
  std::filesystem::path robot;
  std::filesystem::path calibration;
  std::vector<std::string> attached;
};

/// Declares what `palpate-recorder` and `palpate record` have in common.
void DeclareRecord(app::Arguments& arguments, Command* command);

/// After parsing: checks the command. Throws InputError.
void SettleRecord(Command* command);

/// nullopt: --help, --version or --print-config was asked for and printed. Throws InputError.
std::optional<Command> ReadCommand(int argc, const char* const* argv);

/// Throws InputError where an attachment cannot be read, RunError where the file exists.
std::unique_ptr<RecorderNode> MakeNode(const Command& command);

/// Records until a signal, with a table on a terminal, the keys s (snapshot) and q (end), and
/// SIGUSR1 for a snapshot. Returns the exit code. Throws InputError, RunError.
int Record(const Command& command);

}  // namespace palpate::recorder
