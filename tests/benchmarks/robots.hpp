// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>

#include "libs/fem/tet_mesh.hpp"
#include "libs/robot/robot_body.hpp"
#include "libs/robot/robot_description.hpp"

namespace palpate::benchmarks {

struct NamedRobot {
  std::string name;  ///< first part of the names of its benchmarks
  std::string note;  ///< what it is, for people
  robot::RobotDescription description;
  /// How many times each cell of its mesh is cut into eight.
  int refinements = 0;
  /// At most so many repetitions of each benchmark: large meshes take long.
  int max_repetitions = 1000;
  /// So large that the caches are cold and everything takes long, whatever ran before.
  bool large = false;
};

/// The robot of the paper, from the folder of measured data (PALPATE_DATA_DIR, else beside the
/// sources), of this element on the paper's mesh, or tet4 with each cell cut into 8^refinements.
/// Where the folder is not there, our own robot four_leg stands in, as name and note say.
NamedRobot PaperRobot(fem::ElementType element, int refinements = 0);

/// A robot of config/robots, of this element.
NamedRobot OwnRobot(const std::string& name, fem::ElementType element);

/// The robot put together with its mesh. Throws as robot::BuildRobotBody does.
robot::RobotBody BuildBody(const NamedRobot& robot);

}  // namespace palpate::benchmarks
