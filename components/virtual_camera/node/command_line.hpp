// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "components/virtual_camera/node/node.hpp"
#include "libs/app/node_options.hpp"

namespace palpate::virtual_camera {

struct Command : app::NodeCommand<NodeConfig> {
  std::filesystem::path robot;
  std::filesystem::path scenario;
  int seed = 1;
};

/// nullopt: --help, --version or --print-config was asked for and printed. Throws InputError.
std::optional<Command> ReadCommand(int argc, const char* const* argv);

/// Throws InputError where robot and scenario do not fit together, RunError.
std::unique_ptr<VirtualCameraNode> MakeNode(const Command& command);

}  // namespace palpate::virtual_camera
