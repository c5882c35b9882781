// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/virtual_camera/node/command_line.hpp"
#include "libs/app/log.hpp"
#include "libs/app/run_main.hpp"
#include "libs/app/stop_signal.hpp"
#include "libs/app/yaml.hpp"

int main(int argc, char** argv) {
  using namespace palpate;
  return app::RunMain("palpate-virtual-camera", [&]() -> int {
    const auto command = virtual_camera::ReadCommand(argc, argv);
    if (!command) return app::kExitDone;
    app::StartLog("palpate-virtual-camera", command->options);
    virtual_camera::VirtualCameraNode node(
        command->config, virtual_camera::OpenScene(*command), command->options.domain_id,
        dds::LoadTopicTable(command->config.dds, app::LoadYaml, app::ParseYaml), app::Log);
    app::StopSignal stop([&] { node.Stop(); });
    node.Run();
    return app::kExitDone;
  });
}
