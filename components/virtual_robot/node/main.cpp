// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/virtual_robot/node/command_line.hpp"
#include "libs/app/log.hpp"
#include "libs/app/run_main.hpp"
#include "libs/app/stop_signal.hpp"
#include "libs/app/yaml.hpp"

int main(int argc, char** argv) {
  using namespace palpate;
  return app::RunMain("palpate-virtual-robot", [&]() -> int {
    const auto command = virtual_robot::ReadCommand(argc, argv);
    if (!command) return app::kExitDone;
    app::StartLog("palpate-virtual-robot", command->options);
    virtual_robot::VirtualRobotNode node(
        command->config, virtual_robot::OpenBench(*command), command->options.domain_id,
        dds::LoadTopicTable(command->config.dds, app::LoadYaml, app::ParseYaml), app::Log);
    app::StopSignal stop([&] { node.Stop(); });
    node.Run();
    return app::kExitDone;
  });
}
