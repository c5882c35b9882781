// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/node/demo/demo_place.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <utility>

#include "components/palpate/check_output.hpp"
#include "components/palpate/find_robot.hpp"
#include "libs/core/error.hpp"

namespace palpate::command {

namespace {

constexpr int kFirstDomain = 120;  // far from the usual 0
constexpr int kDomains = 100;

/// Beside the programs in a build folder. Installed programs have no folder of results.
std::filesystem::path UsualFolder(const std::filesystem::path& programs) {
  const std::filesystem::path build = programs.parent_path();
  std::error_code none;
  return std::filesystem::exists(build / "CMakeCache.txt", none) ? build / "demo" : "palpate_demo";
}

std::string LastLine(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::string last;
  for (std::string line; std::getline(stream, line);) {
    if (!line.empty()) last = line;
  }
  return last;
}

}  // namespace

std::string DemoPlace::CameraAddress() const { return fmt::format("127.41.{}.1", domain_id); }

std::unique_ptr<app::ChildProcess> DemoPlace::Start(const std::string& program,
                                                    std::vector<std::string> arguments,
                                                    const std::string& log) const {
  arguments.insert(arguments.end(), {"--domain", std::to_string(domain_id)});
  return std::make_unique<app::ChildProcess>(programs / program, arguments,
                                             std::map<std::string, std::string>{}, folder / log);
}

DemoPlace MakeDemoPlace(const std::filesystem::path& out) {
  DemoPlace place;
  place.programs = ProgramFolder();
  place.folder = out.empty() ? UsualFolder(place.programs) : out;
  place.folder = std::filesystem::absolute(place.folder).lexically_normal();
  CheckOutputFolder(place.folder);
  std::error_code error;
  std::filesystem::create_directories(place.folder, error);
  if (error) {
    throw RunError("cannot create " + place.folder.string() + ": " + error.message());
  }
  place.domain_id = kFirstDomain + static_cast<int>(getpid() % kDomains);
  const std::filesystem::path settings = FindProjectFile("config/cyclonedds/one_host.xml");
  if (settings.empty()) throw InputError("config/cyclonedds/one_host.xml is not there");
  setenv("CYCLONEDDS_URI", ("file://" + settings.string()).c_str(), 1);
  return place;
}

void RefuseEnded(const app::ChildProcess& process, int exit_code) {
  RefuseEnded(process.name(), fmt::format("exit code {}", exit_code), process.log());
}

void RefuseEnded(const std::string& process, const std::string& end,
                 const std::filesystem::path& log) {
  throw RunError(
      fmt::format("{} ended with {}: {} (log: {})", process, end, LastLine(log), log.string()));
}

}  // namespace palpate::command
