// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>

#include "libs/app/log.hpp"
#include "libs/app/notify.hpp"
#include "libs/app/parameters.hpp"
#include "libs/app/run_main.hpp"
#include "libs/app/stop_signal.hpp"

namespace palpate::app {

/// The main() of a process that is a node: reads the command line, starts the log, makes the node
/// and runs it until it ends or a signal stops it. Where NOTIFY_SOCKET is set, it says when the
/// node is made: its model is loaded, its readers and writers are there. Returns the exit code.
///
/// `read`(argc, argv): the command, a std::optional of a NodeCommand whose settings have `dds`;
/// nullopt: what was asked for has been printed. `make`(command): a pointer to the node, which has
/// Run() and, to be called from any thread, Stop(). Both may throw InputError and RunError.
template <typename Reader, typename Maker>
int RunNode(const std::string& program, Reader read, Maker make, int argc,
            const char* const* argv) {
  return RunMain(program, [&]() -> int {
    auto command = read(argc, argv);
    if (!command) return kExitDone;
    AddParameters(program, &*command);
    StartLog(program, command->options);
    const auto node = make(*command);
    const StopSignal stop([&] { node->Stop(); });
    NotifyReady();
    node->Run();
    LogInfo("{}", stop.Requested() ? "stopped by a signal" : "ended");
    return kExitDone;
  });
}

}  // namespace palpate::app
