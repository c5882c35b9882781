// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <mutex>
#include <string>
#include <utility>

#include "libs/app/log.hpp"
#include "libs/app/notify.hpp"
#include "libs/app/parameters.hpp"
#include "libs/app/run_main.hpp"
#include "libs/app/stop_signal.hpp"

namespace palpate::app {

/// The main() of a process that is a node: reads the command line, starts the log, makes the node
/// and runs it until it ends or a signal stops it. Where NOTIFY_SOCKET is set, it says when the
/// node is made: its model is loaded, its readers and writers are there. A signal that comes before
/// that is a clean end, too: the node is made, and does not run. Returns the exit code.
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
    // Others may know of the node, and end it, before it is made.
    std::mutex mutex;
    decltype(make(*command)) node;
    const StopSignal stop([&] {
      const std::lock_guard lock(mutex);
      if (node) node->Stop();
    });
    auto made = make(*command);
    {
      const std::lock_guard lock(mutex);
      node = std::move(made);
    }
    if (!stop.Requested()) {
      NotifyReady();
      node->Run();
    }
    LogInfo("{}", stop.Requested() ? "stopped by a signal" : "ended");
    return kExitDone;
  });
}

}  // namespace palpate::app
