// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/player/node/command_line.hpp"
#include "libs/app/run_main.hpp"

int main(int argc, char** argv) {
  using namespace palpate;
  return app::RunMain("palpate-player", [&]() -> int {
    const auto command = player::ReadCommand(argc, argv);
    return command ? player::Play(*command) : app::kExitDone;
  });
}
