// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "libs/app/arguments.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::command {

/// The folder of the running program.
std::filesystem::path ProgramFolder();

/// A file that is part of the project, such as "config/robots/beam.yaml": searched in each folder
/// above the program's, in the share/palpate folder beside them, and in the sources that the
/// program was built from. Empty where it is nowhere.
std::filesystem::path FindProjectFile(const std::filesystem::path& relative);

/// The robot file that `robot` names: a path, or the name of a robot that comes with palpate
/// ("four_leg"). Throws InputError where neither is there, with "did you mean".
std::filesystem::path FindRobotFile(const std::filesystem::path& robot);

/// The names of the robots in config/robots.
std::vector<std::string> KnownRobots();

/// The warnings of the robot file, one line each on the standard error output.
void PrintWarnings(const robot::RobotBody& body);

/// Reads the robot file and its mesh, prints their warnings and makes the model ready to solve, of
/// the geometry that the calibration file (empty: none) says; nothing else of it is applied. Its
/// eyelets can be moved by `eyelet_room_m` (robot/eyelets.hpp). Throws InputError.
std::unique_ptr<robot::RobotModel> LoadRobot(const std::filesystem::path& robot,
                                             const fem::SolverSettings& solver = {},
                                             const std::filesystem::path& calibration = {},
                                             double eyelet_room_m = 0.0);

/// ROBOT, a positional argument: a file or a name that FindRobotFile() takes.
void DeclareRobot(app::Arguments& arguments, std::filesystem::path* robot,
                  app::Need need = app::Need::kRequired);

/// --robot FILE: the same as an option. `use`: what the robot is for.
void DeclareRobotOption(app::Arguments& arguments, std::filesystem::path* robot,
                        const std::string& use);

/// --cable-input: the boundary condition of cables that have two columns.
void DeclareCableInput(app::Arguments& arguments, std::string* cable_input);

/// The options --solver and --threads.
void DeclareSolverOptions(app::Arguments& arguments, fem::SolverSettings* solver);

/// "displacement" or "tension", as the options offer them.
robot::CableInput ParseCableInput(const std::string& word);

}  // namespace palpate::command
