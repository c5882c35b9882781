// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "libs/app/arguments.hpp"
#include "libs/app/project_files.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::command {

using app::DeclareRobot;
using app::DeclareRobotOption;
using app::FindProjectFile;
using app::FindRobotFile;
using app::KnownRobots;
using app::ProgramFolder;

/// The warnings of the robot file, one line each on the standard error output.
void PrintWarnings(const robot::RobotBody& body);

/// Reads the robot file and its mesh, prints their warnings and makes the model ready to solve, of
/// the geometry that the calibration file (empty: none) says; nothing else of it is applied. Its
/// eyelets can be moved by `eyelet_room_m` (robot/eyelets.hpp). Throws InputError.
std::unique_ptr<robot::RobotModel> LoadRobot(const std::filesystem::path& robot,
                                             const fem::SolverSettings& solver = {},
                                             const std::filesystem::path& calibration = {},
                                             double eyelet_room_m = 0.0);

/// --cable-input: the boundary condition of cables that have two columns.
void DeclareCableInput(app::Arguments& arguments, std::string* cable_input);

/// The options --solver and --threads.
void DeclareSolverOptions(app::Arguments& arguments, fem::SolverSettings* solver);

/// "displacement" or "tension", as the options offer them.
robot::CableInput ParseCableInput(const std::string& word);

}  // namespace palpate::command
