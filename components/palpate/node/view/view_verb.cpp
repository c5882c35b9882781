// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/node/view/view_verb.hpp"

#include <fmt/core.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "components/view/node/command_line.hpp"
#include "libs/app/log.hpp"
#include "libs/app/notify.hpp"
#include "libs/app/parameters.hpp"
#include "libs/app/project_files.hpp"
#include "libs/app/run_main.hpp"
#include "libs/app/stop_signal.hpp"
#include "libs/core/error.hpp"

namespace palpate::command {

namespace {

void CheckSource(const std::filesystem::path& source) {
  if (source.empty()) return;
  if (!std::filesystem::exists(source)) {
    throw InputError("SOURCE: " + source.string() +
                     " is not there; without SOURCE the running "
                     "system is shown");
  }
}

int Show(view::Command* command) {
  CheckSource(command->recording);
  app::AddParameters("palpate-view", command);
  app::StartLog("palpate-view", command->options);
  const auto node = view::MakeNode(*command);
  const app::StopSignal stop([&] { node->Stop(); });
  fmt::print("{}\nCtrl-C ends it.\n", node->page_url());
  std::fflush(stdout);
  app::NotifyReady();
  node->Run();
  return app::kExitDone;
}

}  // namespace

app::Verb ViewVerb() {
  return {"view", "Show the running system, a recording, an experiment or a robot in the browser",
          [](app::Arguments& arguments) -> app::Verb::Action {
            const auto command = std::make_shared<view::Command>();
            arguments.Positional("SOURCE", &command->recording,
                                 "Recorded messages (.mcap, .db3, or a folder of them), an "
                                 "experiment folder, or a robot file (.yaml), on which cables are "
                                 "drawn by clicks; without it the running system",
                                 app::Need::kOptional);
            view::DeclareResults(arguments, command.get());
            app::DeclareRobotOption(arguments, &command->robot,
                                    "for cables, stiffness and smallest forces");
            app::DeclareNodeOptions(arguments, &command->options);
            return [command]() -> int {
              if (!app::SettleNodeOptions(app::ListSettings(command->config), &command->options)) {
                return app::kExitDone;
              }
              return Show(command.get());
            };
          }};
}

}  // namespace palpate::command
