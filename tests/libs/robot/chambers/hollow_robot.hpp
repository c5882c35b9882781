// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "libs/robot/robot_model.hpp"
#include "tests/libs/robot/robot_files.hpp"

namespace palpate::robot {

/// A bar of 60 x 20 x 20 mm along x, clamped at x = 0, with two hollows along it, above ("inner
/// skin 2") and below ("1") its axis, and a cable on top of it.
class HollowRobotTest : public testing::Test {
 protected:
  HollowRobotTest();

  /// The robot file with these lines for its chambers.
  std::string Text(const std::string& chambers, const std::string& mesh_file = "bar.msh") const;
  /// Both hollows, `upper` and `lower`.
  std::string Text() const;
  RobotBody BodyOf(const std::string& text) const;
  std::unique_ptr<RobotModel> Build(const std::string& text,
                                    const fem::StaticSettings& settings = {}) const;
  /// What the InputError says that building throws; empty, with a failure, where none is thrown.
  std::string Refusal(const std::string& text) const;

  /// Commands in the order cable, upper, lower.
  static ActuatorCommand Displace(double displacement_m) {
    return {ActuatorCommand::Kind::kDisplacement, displacement_m};
  }
  static ActuatorCommand Force(double force_N) {
    return {ActuatorCommand::Kind::kTension, force_N};
  }
  ActuatorCommand Pressure(const RobotModel& model, int actuator, double pressure_Pa) const {
    return Force(model.traits(actuator).Force_N(pressure_Pa));
  }
  ActuatorCommand Volume(const RobotModel& model, int actuator, double change_m3) const {
    return Displace(model.traits(actuator).Displacement_m(change_m3));
  }

  TestFolder folder_;
};

/// Gmsh 2.2, ASCII: the cells in one physical volume, and triangles in physical surfaces by name.
struct NamedTriangles {
  std::string name;
  Eigen::MatrixXi faces;  ///< [3 x t] nodes
};
void WriteGmsh(const fem::TetMesh& mesh, const std::vector<NamedTriangles>& surfaces,
               const std::filesystem::path& file);

/// Binary STL of triangles, coordinates as they are.
void WriteStl(const geometry::TriangleSurface& surface, const std::filesystem::path& file);

/// The bar in mm.
fem::TetMesh HollowBar_mm();
/// The wall of its upper hollow as a surface of its own, normals into the material.
geometry::TriangleSurface UpperWall_mm();

}  // namespace palpate::robot
