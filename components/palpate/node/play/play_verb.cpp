// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/node/play/play_verb.hpp"

#include <memory>

#include "components/player/node/command_line.hpp"
#include "libs/app/run_main.hpp"

namespace palpate::command {

app::Verb PlayVerb() {
  return {"play", "Play a recording as topics, as if the robot ran now",
          [](app::Arguments& arguments) -> app::Verb::Action {
            const auto command = std::make_shared<player::Command>();
            player::DeclarePlay(arguments, command.get());
            app::DeclareNodeOptions(arguments, &command->options);
            return [command]() -> int {
              if (!app::SettleNodeOptions(app::ListSettings(command->config), &command->options)) {
                return app::kExitDone;
              }
              player::SettlePlay(command.get());
              return player::Play(*command);
            };
          }};
}

}  // namespace palpate::command
