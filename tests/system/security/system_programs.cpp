// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/system/security/system_programs.hpp"

#include <algorithm>

namespace palpate::system_test {

std::string WaitingProgram::Program() const {
  std::string name = "palpate-" + component;
  std::replace(name.begin(), name.end(), '_', '-');
  return name;
}

std::vector<WaitingProgram> WaitingPrograms() {
  const std::string scenario = PALPATE_SOURCE_DIR "/config/scenarios/sensing.yaml";
  const std::string pose = "{translation_m: [0, 0, 1], rotation_xyzw: [1, 0, 0, 0]}";
  return {
      {"capture", {"--camera", "127.0.0.9"}},
      {"perception", {"--set", "markers.color_rgb=[1, 0, 0]"}},
      {"perception", {"--set", "camera.source=driver"}},
      {"perception", {"--set", "camera.source=driver", "--set", "camera.transport=compressed"}},
      {"force_estimation", {"four_leg", "--camera-pose", pose}},
      {"force_estimation", {"four_leg", "--set", "source=markers"}},
      {"calibration", {"four_leg"}},
      {"motion_capture",
       {"--mocap-pose", pose, "--set", "multicast_group=\"\"", "--set", "port=15119", "--set",
        "interface_address=127.0.0.1"}},
      {"view", {"--set", "http.port=0", "--set", "foxglove.port=0"}},
      {"virtual_robot",
       {"four_leg", "--scenario", scenario, "--set", "publish_clock=true", "--set", "threads=1"}},
      {"virtual_camera",
       {"four_leg", "--scenario", scenario, "--set", "interface_address=127.0.0.9"}}};
}

}  // namespace palpate::system_test
