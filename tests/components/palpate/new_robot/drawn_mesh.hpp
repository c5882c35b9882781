// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "libs/fem/tet_mesh.hpp"
#include "tests/support/test_folder.hpp"

namespace palpate::command::test {

/// A group of a drawing: nodes for which `holds` is true (points), or the faces of which all three
/// corners are such (surfaces), or a chain of nodes (curves).
struct DrawnGroup {
  std::string name;
  int dimension = 2;
  std::function<bool(const Eigen::Vector3d&)> holds = {};
  std::vector<Eigen::Vector3d> chain = {};  ///< of dimension 1: the nearest nodes, in this order
};

/// A bar of `size` along the axes with bricks of `counts`, its lower corner in `corner`.
fem::TetMesh Bar(const Eigen::Vector3d& size, const Eigen::Vector3i& counts,
                 const Eigen::Vector3d& corner = Eigen::Vector3d::Zero());

/// A tube along z from 0 to `length`: a round hole of `inner` radius in a cylinder.
fem::TetMesh Tube(double inner, double outer, double length);

/// The mesh with each node moved.
fem::TetMesh Moved(fem::TetMesh mesh,
                   const std::function<Eigen::Vector3d(const Eigen::Vector3d&)>& to);

/// Writes Gmsh 2.2 and returns the file.
std::filesystem::path WriteMsh(const test_support::TestFolder& folder, const std::string& name,
                               const fem::TetMesh& mesh,
                               const std::vector<DrawnGroup>& groups = {});

}  // namespace palpate::command::test
