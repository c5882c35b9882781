// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/find_robot.hpp"

#include <fmt/core.h>

#include <string>
#include <utility>

#include "libs/app/yaml.hpp"
#include "libs/core/check.hpp"
#include "libs/robot/calibration_file.hpp"
#include "libs/robot/eyelets.hpp"
#include "libs/robot/robot_body.hpp"
#include "libs/robot/robot_description.hpp"

namespace palpate::command {

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
                   "Number of threads; results agree to rounding");
}

robot::CableInput ParseCableInput(const std::string& word) {
  PALPATE_CHECK(word == "displacement" || word == "tension", word);
  return word == "tension" ? robot::CableInput::kTension : robot::CableInput::kDisplacement;
}

}  // namespace palpate::command
