// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>

namespace palpate::command {

struct SystemDemoOptions {
  std::filesystem::path out;          ///< empty: demo/ beside the folder of the program
  std::filesystem::path robot;        ///< file or name; empty: four_leg
  std::filesystem::path scenario;     ///< empty: config/scenarios/sensing.yaml
  std::filesystem::path data;         ///< an experiment with images instead of the virtual bench
  std::filesystem::path calibration;  ///< empty: none
  int seconds = 0;  ///< at most; 0: half a minute of the virtual bench, all of recordings
};

/// `palpate demo`: the whole system on one machine. Virtual robot and camera, capture, perception
/// and force estimation run as processes; a line of forces against truth while it runs, a summary,
/// forces.svg and scene.png afterwards. With `data`, its recordings are played instead, and there
/// is no truth. Returns 0 where forces were found (and compared), else 1; throws InputError and
/// RunError. SIGINT ends all processes.
int SystemDemo(const SystemDemoOptions& options);

}  // namespace palpate::command
