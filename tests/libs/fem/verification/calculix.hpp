// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>

#include "tests/libs/fem/verification/static_problem.hpp"

namespace palpate::fem::verification {

/// The program `ccx` on PATH; nothing where it is not installed.
std::optional<std::filesystem::path> FindCalculix();

/// The problem as an input deck: C3D4 or C3D10 on the same nodes and cells, NLGEOM, the same nodal
/// forces and pressures on faces, every held direction at 0. The material is CalculiX's own
/// neo-Hookean with the same E and nu, W = mu/2 (I1 J^(-2/3) - 3) + K/2 (J - 1)^2, whatever the
/// problem's model.
void WriteCalculixInput(const StaticProblem& problem, const std::filesystem::path& file);

/// Displacements [3n], m, of the last increment in a .dat file; throws std::runtime_error where a
/// node is missing.
Eigen::VectorXd ReadCalculixDisplacements(const std::filesystem::path& file, int node_count);

/// Runs ccx on one thread in a fresh temporary folder, which goes again. Throws std::runtime_error
/// with the end of its output where it finds no solution.
Eigen::VectorXd SolveWithCalculix(const std::filesystem::path& ccx, const StaticProblem& problem);

}  // namespace palpate::fem::verification
