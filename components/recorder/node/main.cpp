// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/recorder/node/command_line.hpp"
#include "libs/app/run_main.hpp"

int main(int argc, char** argv) {
  using namespace palpate;
  return app::RunMain("palpate-recorder", [&]() -> int {
    const auto command = recorder::ReadCommand(argc, argv);
    return command ? recorder::Record(*command) : app::kExitDone;
  });
}
