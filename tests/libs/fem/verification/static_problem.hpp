// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "libs/fem/fibre.hpp"
#include "libs/fem/linearisation.hpp"
#include "libs/fem/static_solver.hpp"
#include "tests/libs/fem/verification/grid_mesh.hpp"

namespace palpate::fem::verification {

using VectorField = std::function<Eigen::Vector3d(const Eigen::Vector3d&)>;

/// Pressure on the face of a cell that lies opposite to one of its corners.
struct FacePressure {
  int cell = 0;
  int opposite_corner = 0;
  double pressure_Pa = 0.0;
};

/// A body with its supports and dead loads, as a textbook states it.
struct StaticProblem {
  StaticProblem(TetMesh body_mesh, const Material& body_material);

  /// Holds the nodes that pass in these directions, at their rest position.
  void Fix(const PointTest& test, bool x = true, bool y = true, bool z = true);
  /// Holds the nodes that pass where `position` of their rest position says.
  void Prescribe(const PointTest& test, const VectorField& position);
  /// Traction in N/m2 of the rest surface on the faces all of whose nodes pass; consistent nodal
  /// forces, integrated on the (possibly curved) faces.
  void AddTraction(const PointTest& test, const VectorField& traction_Pa);
  /// Force for each volume of the rest shape, N/m3.
  void AddBodyForce(const VectorField& force_N_m3);

  TetMesh mesh;
  Material material;
  FixedDirections fixed;             ///< [3 x n]
  Eigen::VectorXd fixed_position_m;  ///< [3n]
  Eigen::VectorXd external_force_N;  ///< [3n]
  std::vector<ScalarConstraint*> constraints;
  std::vector<ConstraintCommand> commands;
  std::vector<EmbeddedFibre> fibres;
  std::vector<FacePressure> pressures;  ///< for CalculiX; here a constraint presses
};

struct Solution {
  StaticResult result;
  Eigen::VectorXd x_m;  ///< [3n]
  Eigen::VectorXd u_m;  ///< [3n]

  Eigen::Vector3d Displacement(int node) const { return u_m.segment<3>(3 * node); }
};

/// The equilibrium reached from the rest shape.
Solution Solve(const StaticProblem& problem);

/// The same through `steps` equilibria under equal parts of the loads and multipliers; for bodies
/// so slender that there are several equilibria.
Solution SolveInSteps(const StaticProblem& problem, int steps);

}  // namespace palpate::fem::verification
