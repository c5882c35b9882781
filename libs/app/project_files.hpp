// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "libs/app/arguments.hpp"

namespace palpate::app {

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

/// ROBOT, a positional argument: a file or a name that FindRobotFile() takes.
void DeclareRobot(Arguments& arguments, std::filesystem::path* robot, Need need = Need::kRequired);

/// --robot FILE: the same as an option. `use`: what the robot is for.
void DeclareRobotOption(Arguments& arguments, std::filesystem::path* robot, const std::string& use);

/// ROBOT of a process, which --print-config does without: the same, not required by the parser.
void DeclareRobotToRun(Arguments& arguments, std::filesystem::path* robot);

/// The file of such a ROBOT. Throws InputError where none was given, or as FindRobotFile().
std::filesystem::path RobotFileToRun(const std::filesystem::path& robot);

}  // namespace palpate::app
