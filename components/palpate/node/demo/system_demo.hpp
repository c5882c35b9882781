// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace palpate::command {

struct SystemDemoOptions {
  std::filesystem::path out;          ///< empty: demo/ beside the folder of the program
  std::filesystem::path robot;        ///< file or name; empty: four_leg
  std::filesystem::path scenario;     ///< empty: of four_leg sensing.yaml, else TouchScenario
  std::filesystem::path data;         ///< an experiment with images instead of the virtual robot
  std::vector<std::string> remap;     ///< FROM:=TO, or __ns:=/NAMESPACE, of the processes
  std::filesystem::path calibration;  ///< empty: none
  bool no_view = false;               ///< without the live page
  int seconds = 0;  ///< duration; 0: 30 s of the virtual robot's time, all of recordings
};

/// `palpate demo`: the whole system on one machine. Virtual robot and camera, capture, perception
/// and force estimation run as processes; prints forces against truth while it runs, then a
/// summary, and writes forces.svg, scene.png and recording.mcap, which `palpate view` shows. With
/// `data`, its recordings are played instead, without truth. Returns 0 where forces were detected
/// (and compared), else 1; throws InputError and RunError. SIGINT ends all processes.
int SystemDemo(const SystemDemoOptions& options);

}  // namespace palpate::command
