// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/node/command_line.hpp"
#include "libs/app/log.hpp"
#include "libs/app/run_main.hpp"
#include "libs/app/stop_signal.hpp"

int main(int argc, char** argv) {
  using namespace palpate;
  return app::RunMain("palpate-calibration", [&]() -> int {
    const auto command = calibration::ReadCommand(argc, argv);
    if (!command) return app::kExitDone;
    app::StartLog("palpate-calibration", command->options);
    const auto node = calibration::MakeNode(*command);
    app::StopSignal stop([&] { node->Stop(); });
    node->Run();
    return app::kExitDone;
  });
}
