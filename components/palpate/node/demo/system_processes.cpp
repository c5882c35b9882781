// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/node/demo/system_processes.hpp"

#include <optional>

#include "libs/core/text.hpp"
#include "libs/geometry/pose_text.hpp"

namespace palpate::command {

namespace {

// Random seed; fixed, so that each run is the same.
const char* const kSeed = "7";

std::vector<std::string> BenchArguments(const std::filesystem::path& robot,
                                        const std::filesystem::path& scenario) {
  return {robot.string(), "--scenario", scenario.string(), "--seed", kSeed};
}

}  // namespace

void SystemProcesses::Start(const std::string& program, std::vector<std::string> arguments) {
  for (const std::string& rule : remap_) arguments.insert(arguments.end(), {"--remap", rule});
  constexpr std::string_view kPrefix = "palpate-";
  processes_.push_back(place_.Start(program, arguments, program.substr(kPrefix.size()) + ".log"));
}

void SystemProcesses::StartVirtualCamera(const std::filesystem::path& robot,
                                         const std::filesystem::path& scenario) {
  std::vector<std::string> arguments = BenchArguments(robot, scenario);
  arguments.insert(arguments.end(), {"--set", "interface_address=" + place_.CameraAddress()});
  Start("palpate-virtual-camera", arguments);
  Start("palpate-capture", {"--camera", place_.CameraAddress()});
}

void SystemProcesses::StartVirtualRobot(const std::filesystem::path& robot,
                                        const std::filesystem::path& scenario) {
  std::vector<std::string> arguments = BenchArguments(robot, scenario);
  // The whole system shares the cores: a second solver thread would spin while it waits for one
  // that has no core.
  arguments.insert(arguments.end(), {"--set", "threads=1"});
  Start("palpate-virtual-robot", arguments);
  processes_.back()->GiveWay();  // it stands for the real robot, which needs no core
}

void SystemProcesses::StartPlayer(const std::filesystem::path& data) {
  Start("palpate-player",
        {"--data", std::filesystem::absolute(data).string(), "--images", "--step"});
}

void SystemProcesses::StartSensing(const std::filesystem::path& robot,
                                   const std::filesystem::path& calibration,
                                   const Eigen::Isometry3d& T_robot_camera,
                                   const std::vector<std::string>& overrides) {
  const std::string pose = "camera_pose=" + Quoted(geometry::FormatPose(T_robot_camera));
  Start("palpate-perception", {"--set", pose});
  std::vector<std::string> arguments = {robot.string(), "--set", pose};
  if (!calibration.empty()) {
    arguments.insert(arguments.end(), {"--calibration", calibration.string()});
  }
  for (const std::string& one : overrides) arguments.insert(arguments.end(), {"--set", one});
  Start("palpate-force-estimation", arguments);
}

void SystemProcesses::CheckAlive() {
  for (const auto& process : processes_) {
    const std::optional<int> ended = process->ExitCode();
    if (ended && *ended != 0) RefuseEnded(*process, *ended);
  }
}

bool SystemProcesses::HasEnded(const std::string& program) {
  for (const auto& process : processes_) {
    if (process->name() == program && !process->ExitCode()) return false;
  }
  return true;
}

void SystemProcesses::Stop() {
  for (auto process = processes_.rbegin(); process != processes_.rend(); ++process) {
    (*process)->Stop();
  }
}

}  // namespace palpate::command
