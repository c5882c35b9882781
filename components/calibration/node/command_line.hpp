// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "components/calibration/node/node.hpp"
#include "libs/app/node_options.hpp"

namespace palpate::calibration {

struct Command : app::NodeCommand<NodeConfig> {
  std::filesystem::path robot;
};

/// nullopt: --help, --version or --print-config was printed. Throws InputError.
std::optional<Command> ReadCommand(int argc, const char* const* argv);

/// Reads robot, mesh and the last calibration, and builds the node. Throws InputError, RunError.
std::unique_ptr<CalibrationNode> MakeNode(const Command& command);

}  // namespace palpate::calibration
