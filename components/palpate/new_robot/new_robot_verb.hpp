// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <istream>

#include "components/palpate/new_robot/robot_draft.hpp"
#include "libs/app/verbs.hpp"

namespace palpate::command {

struct NewRobotOptions {
  std::filesystem::path mesh;
  std::filesystem::path out;  ///< folder; empty: the name of the robot, in the current folder
  KnownOfRobot known;
  bool yes = false;    ///< ask nothing
  bool force = false;  ///< replace files of an earlier run
};

/// `palpate new-robot`: makes a robot file of a mesh, with a picture and files to try it.
/// `answers`: where the user's answers are read; null: nobody is there. Throws InputError where
/// something cannot be; then nothing is written. Exit code 1: written, and no equilibrium was
/// found.
int NewRobot(const NewRobotOptions& options, std::istream* answers);

app::Verb NewRobotVerb();

}  // namespace palpate::command
