// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/doctor/machine_facts.hpp"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <thread>

#include "components/capture/camera_list.hpp"
#include "components/palpate/find_robot.hpp"
#include "libs/app/yaml.hpp"
#include "libs/core/clock.hpp"
#include "libs/core/error.hpp"
#include "libs/robot/calibration_file.hpp"

namespace palpate::command {

namespace {

std::string VariableOr(const char* name, const std::string& otherwise = {}) {
  const char* value = std::getenv(name);
  return value == nullptr ? otherwise : value;
}

std::string FirstWordOf(const std::string& file) {
  std::string word;
  std::ifstream(file) >> word;
  return word;
}

}  // namespace

ProcessorFacts ReadProcessor() {
  return {.best = BestInstructionSet(),
          .threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency())),
          .blas_core = VariableOr("OPENBLAS_CORETYPE"),
          .governor = FirstWordOf("/sys/devices/system/cpu/cpu0/cpufreq/scaling_governor"),
          .thread_limit = VariableOr("OMP_NUM_THREADS")};
}

DiskFacts ReadDisk(const std::filesystem::path& folder) {
  std::error_code error;
  const auto space = std::filesystem::space(folder, error);
  return {folder, error ? std::nullopt : std::optional<std::uint64_t>(space.available)};
}

SecurityFacts ReadSecurity(const std::filesystem::path& folder, bool is_on) {
  SecurityFacts facts{.is_on = is_on,
                      .folder = folder,
                      .trouble = {},
                      .state = {},
                      .now_s = WallNow_ns() / 1'000'000'000};
  if (folder.empty()) return facts;
  try {
    facts.state = CheckHostFiles(folder, {}, facts.now_s);
  } catch (const InputError& error) {
    facts.trouble = error.what();
  }
  return facts;
}

std::vector<CameraFacts> FindCameras(const std::vector<std::string>& addresses,
                                     const std::vector<NetworkInterface>& interfaces) {
  std::vector<CameraFacts> cameras;
  for (const capture::CameraDescription& camera : capture::ListCameras(addresses)) {
    CameraFacts facts{.model = camera.vendor + " " + camera.model,
                      .address = camera.address,
                      .mtu_B = 0,
                      .interface = {},
                      .trouble = camera.trouble};
    const std::string local = LocalAddressTo(camera.address);
    for (const NetworkInterface& interface : interfaces) {
      const auto& own = interface.addresses;
      if (std::find(own.begin(), own.end(), local) == own.end()) continue;
      facts.interface = interface.name;
      facts.mtu_B = interface.mtu_B;
    }
    cameras.push_back(facts);
  }
  return cameras;
}

Status CompareRobotFiles(const std::filesystem::path& robot,
                         const std::filesystem::path& calibration) {
  try {
    const auto model = LoadRobot(FindRobotFile(robot), {}, calibration);
    if (calibration.empty()) return Status::Ok();
    return robot::CheckCalibration(robot::ReadCalibrationFile(calibration, app::LoadYaml), *model);
  } catch (const InputError& error) {
    return {StatusCode::kInvalidInput, error.what()};
  }
}

std::optional<std::int64_t> ReadReceiveBufferLimit_B() {
  std::int64_t limit_B = 0;
  if (std::ifstream("/proc/sys/net/core/rmem_max") >> limit_B) return limit_B;
  return std::nullopt;
}

int ReadFirstEphemeralPort() {
  constexpr int kUsual = 32768;
  int first = kUsual;
  std::ifstream("/proc/sys/net/ipv4/ip_local_port_range") >> first;
  return first;
}

}  // namespace palpate::command
