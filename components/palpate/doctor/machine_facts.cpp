// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/doctor/machine_facts.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <memory>
#include <set>
#include <sstream>
#include <thread>

#include "components/capture/camera_list.hpp"
#include "components/palpate/find_robot.hpp"
#include "libs/app/yaml.hpp"
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

std::string InQuotes(const std::string& word) {
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

/// What a shell command prints; empty where it fails.
std::string OutputOf(const std::string& command) {
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  std::string output;
  std::array<char, 256> buffer{};
  while (pipe && std::fgets(buffer.data(), buffer.size(), pipe.get())) output += buffer.data();
  return output;
}

/// "notAfter=2027-11-28 15:00:00Z", as openssl prints it.
std::optional<double> SecondsUntil(const std::string& text) {
  std::tm time{};
  if (strptime(text.c_str(), "notAfter=%Y-%m-%d %H:%M:%SZ", &time) == nullptr) return std::nullopt;
  return std::difftime(timegm(&time), std::time(nullptr));
}

std::string ReadAll(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

void ReadSecurityFile(const std::filesystem::path& file, SecurityFacts* facts) {
  const std::string text = ReadAll(file);
  if (text.find("-----BEGIN CERTIFICATE-----") != text.npos) {
    facts->certificates.push_back(
        {file, SecondsUntil(OutputOf("openssl x509 -noout -enddate -dateopt iso_8601 -in " +
                                     InQuotes(file.string()) + " 2>/dev/null"))});
  }
  if (text.find("PRIVATE KEY-----") == text.npos) return;
  struct stat status {};
  const bool is_open = stat(file.c_str(), &status) == 0 && (status.st_mode & S_IROTH) != 0;
  if (is_open) facts->open_keys.push_back(file);
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
                      .folder_exists = false,
                      .certificates = {},
                      .open_keys = {}};
  std::error_code error;
  facts.folder_exists = !folder.empty() && std::filesystem::is_directory(folder, error);
  if (!facts.folder_exists) return facts;
  std::set<std::filesystem::path> files;
  for (std::filesystem::recursive_directory_iterator it(folder, error), end; !error && it != end;
       it.increment(error)) {
    const bool is_pem = it->path().extension() == ".pem" || it->path().extension() == ".crt" ||
                        it->path().extension() == ".key";
    if (is_pem) files.insert(it->path());
  }
  for (const auto& file : files) ReadSecurityFile(file, &facts);
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
