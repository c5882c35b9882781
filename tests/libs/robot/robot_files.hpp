// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>

#include "libs/core/config_node.hpp"
#include "libs/fem/tet_mesh.hpp"
#include "libs/robot/robot_description.hpp"
#include "tests/support/test_folder.hpp"

namespace palpate::robot {

using test_support::TestFolder;

/// A robot file with every key, on the mesh of WriteBeam: a beam of 100 x 20 x 20 mm along x.
std::string FullRobotText();

/// FullRobotText with `old_text` replaced; the test fails where it is not there exactly once.
std::string Changed(const std::string& old_text, const std::string& new_text);

/// Reads `text` as if it stood in `file`.
RobotDescription ReadText(const std::string& text,
                          const std::filesystem::path& file = "robot.yaml");

/// What the InputError says that reading `text` throws; empty, with a test failure, where none is
/// thrown.
std::string RefusalOf(const std::string& text);

/// A beam of bricks cut into tetrahedra: 10 x 2 x 2 of 10 mm, x from -100 to 0 mm, y and z from
/// -10 to 10 mm; coordinates in millimetres, 4-node cells.
fem::TetMesh Beam_mm();

/// Legacy VTK, ASCII.
void WriteVtk(const fem::TetMesh& mesh, const std::filesystem::path& file);

}  // namespace palpate::robot
