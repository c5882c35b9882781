// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "components/view/node/node.hpp"
#include "libs/app/node_options.hpp"

namespace palpate::view {

struct Command : app::NodeCommand<NodeConfig> {
  std::filesystem::path robot;
  std::filesystem::path recording;  ///< recorded messages, an experiment folder or a robot file
  std::filesystem::path results;    ///< of `palpate estimate` or `palpate diagnose`
};

/// Declares what `palpate-view` and `palpate view` have in common.
void DeclareView(app::Arguments& arguments, Command* command);

/// --results, which DeclareView declares, too.
void DeclareResults(app::Arguments& arguments, Command* command);

/// nullopt: --help, --version or --print-config was asked for and printed. Throws InputError.
std::optional<Command> ReadCommand(int argc, const char* const* argv);

/// Throws InputError for settings that open the page to the network without a token, for a robot or
/// recording that cannot be read; RunError where DDS or the network refuses.
std::unique_ptr<ViewNode> MakeNode(const Command& command);

}  // namespace palpate::view
