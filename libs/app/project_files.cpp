// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/app/project_files.hpp"

#include <algorithm>

#include "libs/core/error.hpp"
#include "libs/core/text.hpp"

namespace palpate::app {

namespace {

bool IsPlainName(const std::filesystem::path& robot) {
  return !robot.empty() && !robot.has_extension() && !robot.has_parent_path();
}

}  // namespace

std::filesystem::path ProgramFolder() {
  std::error_code none;
  return std::filesystem::read_symlink("/proc/self/exe", none).parent_path();
}

std::filesystem::path FindProjectFile(const std::filesystem::path& relative) {
  std::error_code none;
  for (std::filesystem::path folder = ProgramFolder(); folder.has_relative_path();
       folder = folder.parent_path()) {
    for (const auto& candidate : {folder / relative, folder / "share" / "palpate" / relative}) {
      if (std::filesystem::exists(candidate, none)) {
        return candidate;
      }
    }
  }
  const auto in_sources = std::filesystem::path(PALPATE_SOURCE_DIR) / relative;
  return std::filesystem::exists(in_sources, none) ? in_sources : std::filesystem::path();
}

std::vector<std::string> KnownRobots() {
  std::vector<std::string> names;
  const std::filesystem::path folder = FindProjectFile("config/robots");
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(folder, none)) {
    if (entry.path().extension() == ".yaml") {
      names.push_back(entry.path().stem().string());
    }
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::filesystem::path FindRobotFile(const std::filesystem::path& robot) {
  std::error_code none;
  if (std::filesystem::is_regular_file(robot, none)) {
    return robot;
  }
  if (!IsPlainName(robot)) {
    throw InputError("no robot file '" + robot.string() + "'");
  }
  const auto named =
      FindProjectFile(std::filesystem::path("config/robots") / (robot.string() + ".yaml"));
  if (named.empty()) {
    throw InputError("no robot file '" + robot.string() + "', nor a robot of that name" +
                     DidYouMean(robot.string(), KnownRobots()));
  }
  return named;
}

void DeclareRobot(Arguments& arguments, std::filesystem::path* robot, Need need) {
  arguments.Positional("ROBOT", robot, "Robot file, or name of a robot in config/robots", need);
  arguments.Suggest("ROBOT", KnownRobots());
}

void DeclareRobotOption(Arguments& arguments, std::filesystem::path* robot,
                        const std::string& use) {
  arguments.Option("--robot", robot, "Robot file, or name of a robot in config/robots: " + use);
  arguments.Suggest("--robot", KnownRobots());
}

void DeclareRobotToRun(Arguments& arguments, std::filesystem::path* robot) {
  arguments.Positional("ROBOT", robot,
                       "Robot file, or name of a robot in config/robots; required to run",
                       Need::kOptional);
  arguments.Suggest("ROBOT", KnownRobots());
}

std::filesystem::path RobotFileToRun(const std::filesystem::path& robot) {
  if (!robot.empty()) return FindRobotFile(robot);
  throw InputError("ROBOT is required: give a robot file, or the name of a robot (" +
                   Listed(KnownRobots()) + ")");
}

}  // namespace palpate::app
