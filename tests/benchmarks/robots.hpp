// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>

#include "libs/robot/robot_description.hpp"

namespace palpate::benchmarks {

struct NamedRobot {
  std::string name;  ///< first part of the names of its benchmarks
  std::string note;  ///< what it is, for people
  robot::RobotDescription description;
};

/// The robot of the paper, tet4, from the folder of measured data (PALPATE_DATA_DIR, else beside
/// the sources); where that is not there, our own robot stands in, as name and note say.
NamedRobot PaperRobot();

/// A robot of config/robots, of this element.
NamedRobot OwnRobot(const std::string& name, fem::ElementType element);

}  // namespace palpate::benchmarks
