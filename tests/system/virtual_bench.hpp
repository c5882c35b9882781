// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tests/system/process.hpp"
#include "tests/system/sample_data.hpp"

namespace palpate::system_test {

/// The virtual bench as a user starts it: palpate-virtual-robot, palpate-virtual-camera and
/// palpate-capture, each a process that can be killed and started again.
class VirtualBench {
 public:
  struct Settings {
    std::string camera_address = "127.0.0.1";
    std::filesystem::path scenario = {};          ///< empty: a ball that presses a coarse body
    double loss = 0.0;                            ///< of the stream's packets
    std::string noise = "none";                   ///< of the depth image: none | stereo
    std::vector<std::string> bench_wrapper = {};  ///< in front of robot and camera
    std::vector<std::string> robot_arguments = {};
  };

  VirtualBench(const TestFolder& folder, Settings settings);

  void StartRobot(const std::vector<std::string>& more_arguments = {});
  void StartCamera();
  void StartCapture();
  void StartAll();
  void Kill(std::unique_ptr<Process>& process);

  std::unique_ptr<Process> robot;
  std::unique_ptr<Process> camera;
  std::unique_ptr<Process> capture;

 private:
  std::vector<std::string> SceneArguments() const;
  std::filesystem::path Log(const std::string& name);

  const TestFolder& folder_;
  Settings settings_;
  std::filesystem::path scenario_;
  int log_number_ = 0;
};

}  // namespace palpate::system_test
