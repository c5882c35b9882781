// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <malloc.h>

#include <iostream>

#include "components/capture/camera_list.hpp"
#include "components/capture/node/command_line.hpp"
#include "libs/app/run_node.hpp"

namespace {

/// glibc raises this limit to the largest block that was ever given back; the image buffers of a
/// camera that has gone would then stay in a heap that is full of holes.
constexpr int kBytesOfItsOwn = 256 * 1024;

}  // namespace

int main(int argc, char** argv) {
  using namespace palpate;
  mallopt(M_MMAP_THRESHOLD, kBytesOfItsOwn);
  const auto read = [](int count, const char* const* words) {
    auto command = capture::ReadCommand(count, words);
    if (command && command->list) {
      capture::PrintCameras(capture::ListCameras(command->addresses), std::cout);
      command.reset();
    }
    return command;
  };
  return app::RunNode("palpate-capture", read, capture::MakeNode, argc, argv);
}
