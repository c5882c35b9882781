// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/node/watch/watch_verb.hpp"

#include <fmt/core.h>

#include <cstdio>
#include <memory>
#include <string>

#include "components/palpate/compare/live_line.hpp"
#include "components/palpate/node/live/terminal.hpp"
#include "components/palpate/node/watch/snapshot_text.hpp"
#include "components/palpate/node/watch/system_listener.hpp"
#include "libs/app/node_options.hpp"
#include "libs/app/project_files.hpp"
#include "libs/app/run_main.hpp"
#include "libs/app/stop_signal.hpp"
#include "libs/core/error.hpp"
#include "libs/core/text.hpp"
#include "libs/monitor/snapshot_json.hpp"

namespace palpate::command {

namespace {

using std::chrono::duration;

constexpr double kLeastRate_hz = 0.1;
constexpr double kMostRate_hz = 20.0;
/// Every process reports once a second, and rates need two messages.
constexpr duration<double> kOneReport = std::chrono::milliseconds(1200);

/// Replaces what the terminal shows, cut to its size.
void ShowInPlace(const std::string& text) {
  const TerminalSize size = SizeOfTerminal();
  std::string screen = "\033[H";
  std::size_t rows = 0;
  for (std::size_t begin = 0; begin < text.size() && rows + 1 < size.rows; ++rows) {
    const std::size_t end = text.find('\n', begin);
    screen += Cut(text.substr(begin, end - begin), size.columns) + "\033[K\n";
    begin = end + 1;
  }
  fmt::print("{}\033[J", screen);
}

void Show(const monitor::SystemSnapshot& snapshot, const WatchOptions& options) {
  if (options.json) {
    fmt::print("{}\n", monitor::SnapshotJson(snapshot));
  } else if (options.once) {
    fmt::print("{}", SnapshotText(snapshot));
  } else if (IsTerminal()) {
    ShowInPlace(SnapshotText(snapshot));
  } else {
    fmt::print("{}\n", SnapshotText(snapshot));
  }
  std::fflush(stdout);
}

int WatchOnce(const WatchOptions& options, SystemListener* listener) {
  const app::StopSignal stop;
  const auto begin = dds::WaitSet::Clock::now();
  const auto complete = [&] {
    return stop.Requested() ||
           (listener->HeardAll() && dds::WaitSet::Clock::now() - begin >= kOneReport);
  };
  listener->Listen(complete, duration<double>(options.timeout_s));
  const monitor::SystemSnapshot snapshot = listener->Snapshot();
  Show(snapshot, options);
  return snapshot.processes.empty() ? app::kExitFailed : app::kExitDone;
}

int WatchOn(const WatchOptions& options, SystemListener* listener) {
  const app::StopSignal stop;
  if (IsTerminal() && !options.json) fmt::print("\033[2J");
  while (!stop.Requested()) {
    listener->Listen([&] { return stop.Requested(); }, duration<double>(1.0 / options.rate_hz));
    if (!stop.Requested()) Show(listener->Snapshot(), options);
  }
  return app::kExitDone;
}

}  // namespace

int Watch(const WatchOptions& options) {
  if (options.rate_hz < kLeastRate_hz || options.rate_hz > kMostRate_hz) {
    throw InputError(fmt::format("--rate must be {} to {} Hz, not {}", kLeastRate_hz, kMostRate_hz,
                                 FormatNumber(options.rate_hz)));
  }
  if (options.timeout_s <= 0.0) {
    throw InputError("--timeout must be above 0 s, not " + FormatNumber(options.timeout_s));
  }
  SystemListener listener(options.domain_id, options.remap, options.robot);
  return options.once ? WatchOnce(options, &listener) : WatchOn(options, &listener);
}

app::Verb WatchVerb() {
  return {"watch", "Show forces, rates and the state of all processes of the running system",
          [](app::Arguments& arguments) -> app::Verb::Action {
            const auto options = std::make_shared<WatchOptions>();
            app::DeclareDomain(arguments, &options->domain_id);
            app::DeclareSecurity(arguments, &options->keystore);
            arguments.Repeated("--remap FROM:=TO", &options->remap,
                               "Another name for a topic, or __ns:=/left for all of a namespace");
            DeclareRobotOption(arguments, &options->robot,
                               "the robot whose file says which joints are chambers; without it "
                               "the one in config/robots with the name of the published mesh");
            arguments.Flag("--once", &options->once,
                           "Print one state when all processes have reported, and exit; exit code "
                           "1 where none does");
            arguments.Option("--timeout S", &options->timeout_s,
                             "With --once: longest wait for the processes, s");
            arguments.Flag("--json", &options->json, "Print each state as one JSON object a line");
            arguments.Option("--rate HZ", &options->rate_hz, "States shown per second, 0.1 to 20");
            return [options] {
              app::SettleDomain(&options->domain_id);
              app::SettleSecurity(options->keystore);
              return Watch(*options);
            };
          }};
}

}  // namespace palpate::command
