// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/system/virtual_bench.hpp"

#include <signal.h>

#include <sstream>

#include "libs/core/file.hpp"
#include "libs/core/text.hpp"

namespace palpate::system_test {

namespace {

/// A ball that presses the hub down and comes back, seen by a camera as CAPTURE has it.
std::string ScenarioText(const std::string& noise) {
  std::ostringstream text;
  text << R"(name: streaming
body: {refine: 0, element: tet4}
motion: {mode: quasi_static}
tools:
  - {name: ball, shape: sphere, radius_m: 0.012}
camera:
  depth: {width_px: 848, height_px: 480, fx_px: 665, fy_px: 665, cx_px: 423.5, cy_px: 239.5,
          distortion: [0, 0, 0, 0, 0], unit_m: 1.0e-4, invalid_value: 0, baseline_m: 0.055}
  color: {width_px: 848, height_px: 480, fx_px: 700, fy_px: 700, cx_px: 423.5, cy_px: 239.5,
          distortion: [0, 0, 0, 0, 0], registered_to_depth: false,
          T_depth_color: {translation_m: [0.015, 0, 0], rotation_xyzw: [0, 0, 0, 1]}}
  eye_m: [0.25, -0.35, 0.25]
  target_m: [0, 0, 0.07]
  rate_hz: 30
  noise: {sensor: )"
       << noise << R"(}
rest_between_s: 0.5
recordings:
  - name: press
    kind: free
    duration_s: 4
    commands:
      - {t_s: 0, north.displacement_m: 0}
      - {t_s: 2, north.displacement_m: 0.004}
      - {t_s: 4, north.displacement_m: 0}
    tools:
      - tool: ball
        path:
          - {t_s: 0, position_m: [0, 0, 0.160]}
          - {t_s: 2, position_m: [0, 0, 0.134]}
          - {t_s: 4, position_m: [0, 0, 0.160]}
)";
  return text.str();
}

}  // namespace

VirtualBench::VirtualBench(const TestFolder& folder, Settings settings)
    : folder_{folder}, settings_{std::move(settings)}, scenario_{settings_.scenario} {
  if (!scenario_.empty()) return;
  scenario_ = folder / "scenario.yaml";
  WriteFile(scenario_, ScenarioText(settings_.noise));
}

void VirtualBench::StartRobot(const std::vector<std::string>& more_arguments) {
  std::vector<std::string> arguments = SceneArguments();
  arguments.insert(arguments.end(), settings_.robot_arguments.begin(),
                   settings_.robot_arguments.end());
  arguments.insert(arguments.end(), more_arguments.begin(), more_arguments.end());
  robot = std::make_unique<Process>("palpate-virtual-robot", arguments, Log("robot"),
                                    settings_.bench_wrapper);
}

void VirtualBench::StartCamera() {
  std::vector<std::string> arguments = SceneArguments();
  for (const std::string& setting : {"interface_address=" + settings_.camera_address,
                                     "network.loss=" + FormatNumber(settings_.loss)}) {
    arguments.insert(arguments.end(), {"--set", setting});
  }
  camera = std::make_unique<Process>("palpate-virtual-camera", arguments, Log("camera"),
                                     settings_.bench_wrapper);
}

void VirtualBench::StartCapture() {
  capture = std::make_unique<Process>(
      "palpate-capture",
      std::vector<std::string>{"--set", "genicam.camera_id=" + settings_.camera_address},
      Log("capture"));
}

void VirtualBench::StartAll() {
  StartCamera();
  StartCapture();
  StartRobot();
}

void VirtualBench::Kill(std::unique_ptr<Process>& process) {
  process->Signal(SIGKILL);
  process.reset();
}

std::vector<std::string> VirtualBench::SceneArguments() const {
  return {std::string(PALPATE_SOURCE_DIR) + "/config/robots/four_leg.yaml", "--scenario",
          scenario_.string(), "--seed", "7"};
}

std::filesystem::path VirtualBench::Log(const std::string& name) {
  return folder_ / (name + std::to_string(log_number_++) + ".log");
}

}  // namespace palpate::system_test
