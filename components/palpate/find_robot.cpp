// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/find_robot.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "libs/app/yaml.hpp"
#include "libs/core/check.hpp"
#include "libs/core/error.hpp"
#include "libs/core/text.hpp"
#include "libs/robot/calibration_file.hpp"
#include "libs/robot/eyelets.hpp"
#include "libs/robot/robot_body.hpp"
#include "libs/robot/robot_description.hpp"

namespace palpate::command {

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

void PrintWarnings(const robot::RobotBody& body) {
  for (const std::string& warning : body.warnings) {
    fmt::print(stderr, "palpate: warning: robot {}: {}\n", body.name, warning);
  }
}

std::unique_ptr<robot::RobotModel> LoadRobot(const std::filesystem::path& robot,
                                             const fem::SolverSettings& solver,
                                             const std::filesystem::path& calibration,
                                             double eyelet_room_m) {
  auto body = robot::BuildRobotBody(robot::ReadRobotFile(FindRobotFile(robot), app::LoadYaml));
  if (!calibration.empty()) {
    robot::ApplyGeometry(robot::ReadCalibrationFile(calibration, app::LoadYaml), &body);
  }
  PrintWarnings(body);
  if (eyelet_room_m > 0.0) robot::GiveEyeletsRoom(eyelet_room_m, &body);
  return std::make_unique<robot::RobotModel>(std::move(body), fem::StaticSettings{}, solver);
}

void DeclareRobot(app::Arguments& arguments, std::filesystem::path* robot, app::Need need) {
  arguments.Positional("ROBOT", robot, "Robot file, or name of a robot in config/robots", need);
  arguments.Suggest("ROBOT", KnownRobots());
}

void DeclareRobotOption(app::Arguments& arguments, std::filesystem::path* robot,
                        const std::string& use) {
  arguments.Option("--robot", robot, "Robot file, or name of a robot in config/robots: " + use);
  arguments.Suggest("--robot", KnownRobots());
}

void DeclareCableInput(app::Arguments& arguments, std::string* cable_input) {
  arguments.Choice("--cable-input", cable_input, {"displacement", "tension"},
                   "Boundary condition of cables that have both columns: prescribed displacement "
                   "or tension");
}

void DeclareSolverOptions(app::Arguments& arguments, fem::SolverSettings* solver) {
  constexpr int kMostThreads = 64;
  arguments.Choice("--solver", &solver->solver, fem::SolverNames(),
                   "Sparse Cholesky factorisation of the model");
  arguments.Option("--threads", &solver->threads, 1, kMostThreads,
                   "Number of threads; results do not depend on it");
}

robot::CableInput ParseCableInput(const std::string& word) {
  PALPATE_CHECK(word == "displacement" || word == "tension", word);
  return word == "tension" ? robot::CableInput::kTension : robot::CableInput::kDisplacement;
}

}  // namespace palpate::command
