// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <functional>

#include "libs/fem/enclosed_volume.hpp"
#include "libs/fem/tet_mesh.hpp"

namespace palpate::robot {

/// Radii of the spheres and tubes of the tests.
inline constexpr double kInner_m = 0.010;
inline constexpr double kOuter_m = 0.015;

/// A spherical shell about the origin: `layers` of prisms across the wall, over an octahedron whose
/// edges are cut into `divisions`. Its nodes lie on spheres, mid-edge nodes too.
fem::TetMesh SphericalShell(int layers, int divisions, fem::ElementType element);

/// The shell and what it surrounds, on the same nodes.
struct FilledShell {
  fem::TetMesh shell, inside;
};
FilledShell FillShell(int layers, int divisions, fem::ElementType element);

/// A tube about the z axis from z = 0 to `length_m`, one strip of `around` prisms long.
fem::TetMesh Tube(double length_m, int layers, int around, fem::ElementType element);

/// The mesh with the cells whose centroid is kept, and the nodes that these use.
fem::TetMesh KeepCells(const fem::TetMesh& mesh,
                       const std::function<bool(const Eigen::Vector3d&)>& keep);

/// The wall of the first closed cavity of a mesh, its outside in the material.
fem::MovingSurface CavityWall(const fem::TetMesh& mesh);

/// The inner wall of a Tube, closed by flat lids that hang on its rims.
fem::MovingSurface TubeWall(const fem::TetMesh& tube, double length_m);

/// All nodes moved by up to `amount_m` in each direction (fixed seed).
Eigen::VectorXd Shaken(const fem::TetMesh& mesh, double amount_m);

}  // namespace palpate::robot
