// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <memory>
#include <optional>

#include "components/motion_capture/node/node.hpp"
#include "libs/app/node_options.hpp"

namespace palpate::motion_capture {

using Command = app::NodeCommand<NodeConfig>;

/// nullopt: --help, --version or --print-config was asked for and printed. Throws InputError.
std::optional<Command> ReadCommand(int argc, const char* const* argv);

/// Throws InputError for settings without T_robot_mocap, RunError.
std::unique_ptr<MotionCaptureNode> MakeNode(const Command& command);

}  // namespace palpate::motion_capture
