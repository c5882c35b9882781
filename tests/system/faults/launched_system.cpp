// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/system/faults/launched_system.hpp"

#include <fstream>
#include <iterator>
#include <sstream>

#include "libs/app/yaml.hpp"
#include "libs/core/file.hpp"
#include "libs/geometry/pose_text.hpp"
#include "libs/scenario/scenario.hpp"
#include "tests/support/scenarios.hpp"

namespace palpate::system_test {

namespace {

using Settings = LaunchedSystem::Settings;

std::string ProcessText(const std::string& component, const std::string& more,
                        const Settings& settings) {
  std::string text = "      - {name: " + component + ", component: " + component + ", " + more;
  if (!settings.respawn.empty()) text += ", respawn: " + settings.respawn;
  return text + "}\n";
}

std::string SystemText(const std::string& camera_pose, const Settings& settings) {
  const std::string robot = std::string(PALPATE_SOURCE_DIR) + "/config/robots/four_leg.yaml";
  const std::string bench =
      "arguments: [" + robot + ", --scenario, $(dirname)/held.yaml, --seed, 7], ";
  const std::string pose = "camera_pose: \"" + camera_pose + "\"";
  std::ostringstream text;
  text << "name: test\n"
       << settings.keys << "hosts:\n  - name: here\n    processes:\n"
       << ProcessText("virtual_camera",
                      bench + "set: {interface_address: " + settings.camera_address + "}", settings)
       << ProcessText("capture", "set: {genicam.camera_id: \"" + settings.camera_address + "\"}",
                      settings)
       << ProcessText("perception", "set: {" + pose + "}", settings)
       << ProcessText("force_estimation",
                      "arguments: [" + robot + "], set: {" + pose +
                          ", shape.untouched_frames: 8, silence_s: 1}",
                      settings)
       << ProcessText("virtual_robot",
                      bench +
                          "set: {threads: 1, rate_hz: 10}, nice: 5, after: [virtual_camera, "
                          "capture, perception, force_estimation]",
                      settings);
  return text.str();
}

/// Writes the scenario and the system file; the words of the command.
std::vector<std::string> Words(const TestFolder& folder, const Settings& settings) {
  const std::filesystem::path config = std::filesystem::path(PALPATE_SOURCE_DIR) / "config";
  std::filesystem::copy_file(config / "scenarios/four_leg_coarse.msh",
                             folder / "four_leg_coarse.msh");
  WriteFile(folder / "held.yaml",
            "name: held\n" + test_support::BodyOfAnotherModulus("four_leg_coarse.msh") +
                test_support::kBallBeforeASmallCamera + test_support::kBallThatHolds);
  const std::string pose = geometry::FormatPose(
      scenario::ReadScenario(folder / "held.yaml", app::LoadYaml).camera->T_robot_camera);
  WriteFile(folder / "system.yaml", SystemText(pose, settings));
  return {"launch", (folder / "system.yaml").string()};
}

}  // namespace

LaunchedSystem::LaunchedSystem(const TestFolder& folder, const Settings& settings)
    : launch_("palpate", Words(folder, settings), folder / "launch.log") {}

std::map<std::string, pid_t> LaunchedSystem::Pids() const {
  const std::string pid = std::to_string(launch_.pid());
  std::ifstream children("/proc/" + pid + "/task/" + pid + "/children");
  std::map<std::string, pid_t> pids;
  for (pid_t child = 0; children >> child;) {
    std::ifstream stream("/proc/" + std::to_string(child) + "/cmdline");
    std::string program;
    std::getline(stream, program, '\0');
    program = std::filesystem::path(program).filename().string();
    constexpr std::string_view kPrefix = "palpate-";
    if (!program.starts_with(kPrefix)) continue;  // the guardian
    std::string component = program.substr(kPrefix.size());
    for (char& c : component) c = c == '-' ? '_' : c;
    pids[component] = child;
  }
  return pids;
}

}  // namespace palpate::system_test
