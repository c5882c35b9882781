// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

// read_timer FILE TIMES: reads a mesh or a motion capture, and prints the seconds of each time.

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "libs/core/error.hpp"
#include "libs/experiment/captured_markers.hpp"
#include "libs/fem/mesh_io/read_mesh.hpp"

namespace {

std::size_t CountOf(const std::filesystem::path& file) {
  if (file.extension() == ".c3d") {
    return palpate::experiment::ReadCapture(file).tracks.frames.size();
  }
  return static_cast<std::size_t>(palpate::fem::ReadMesh(file, 1.0).CellCount());
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 3) return 2;
  try {
    for (int left = std::atoi(arguments[2]); left > 0; --left) {
      const auto begin = std::chrono::steady_clock::now();
      const std::size_t items = CountOf(arguments[1]);
      const std::chrono::duration<double> duration = std::chrono::steady_clock::now() - begin;
      std::printf("%zu %.6f\n", items, duration.count());
    }
  } catch (const palpate::InputError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
