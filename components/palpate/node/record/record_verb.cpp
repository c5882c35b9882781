// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/node/record/record_verb.hpp"

#include <memory>

#include "components/recorder/node/command_line.hpp"
#include "libs/app/run_main.hpp"

namespace palpate::command {

app::Verb RecordVerb() {
  return {"record", "Record the topics of a domain as an MCAP file",
          [](app::Arguments& arguments) -> app::Verb::Action {
            const auto command = std::make_shared<recorder::Command>();
            recorder::DeclareRecord(arguments, command.get());
            app::DeclareNodeOptions(arguments, &command->options);
            return [command]() -> int {
              if (!app::SettleNodeOptions(app::ListSettings(command->config), &command->options)) {
                return app::kExitDone;
              }
              recorder::SettleRecord(command.get());
              return recorder::Record(*command);
            };
          }};
}

}  // namespace palpate::command
