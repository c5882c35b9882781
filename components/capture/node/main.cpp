// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <malloc.h>

#include <iostream>

#include "components/capture/camera_list.hpp"
#include "components/capture/make_source.hpp"
#include "components/capture/node/command_line.hpp"
#include "libs/app/log.hpp"
#include "libs/app/run_main.hpp"
#include "libs/app/stop_signal.hpp"
#include "libs/app/yaml.hpp"

namespace {

/// glibc raises this limit to the largest block that was ever given back; the image buffers of a
/// camera that has gone would then stay in a heap that is full of holes.
constexpr int kBytesOfItsOwn = 256 * 1024;

}  // namespace

int main(int argc, char** argv) {
  using namespace palpate;
  mallopt(M_MMAP_THRESHOLD, kBytesOfItsOwn);
  return app::RunMain("palpate-capture", [&]() -> int {
    const auto command = capture::ReadCommand(argc, argv);
    if (!command) return app::kExitDone;
    if (command->list) {
      capture::PrintCameras(capture::ListCameras(command->addresses), std::cout);
      return app::kExitDone;
    }
    app::StartLog("palpate-capture", command->options);
    capture::CaptureNode node(
        command->config, capture::MakeSource(command->config, app::LoadYaml),
        command->options.domain_id,
        dds::LoadTopicTable(command->config.dds, app::LoadYaml, app::ParseYaml), app::Log);
    app::StopSignal stop([&] { node.Stop(); });
    node.Run();
    return app::kExitDone;
  });
}
