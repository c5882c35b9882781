// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "components/perception/node/node.hpp"
#include "libs/app/node_options.hpp"

namespace palpate::perception {

struct Command : app::NodeCommand<NodeConfig> {
  std::filesystem::path calibration;  ///< empty: poses are those of the settings
};

/// nullopt: --help, --version or --print-config was asked for and printed. Throws InputError.
std::optional<Command> ReadCommand(int argc, const char* const* argv);

/// Throws InputError, RunError.
std::unique_ptr<PerceptionNode> MakeNode(const Command& command);

}  // namespace palpate::perception
