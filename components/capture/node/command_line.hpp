// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "components/capture/node/node.hpp"
#include "libs/app/node_options.hpp"

namespace palpate::capture {

struct Command : app::NodeCommand<NodeConfig> {
  bool list = false;  ///< show the cameras, and nothing else
  std::vector<std::string> addresses;
};

/// nullopt: --help, --version or --print-config was asked for and printed. Throws InputError.
std::optional<Command> ReadCommand(int argc, const char* const* argv);

/// Throws InputError, RunError.
std::unique_ptr<CaptureNode> MakeNode(const Command& command);

}  // namespace palpate::capture
