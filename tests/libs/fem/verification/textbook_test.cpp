// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "libs/fem/shape_functions.hpp"
#include "tests/libs/fem/verification/static_problem.hpp"

namespace palpate::fem::verification {
namespace {

/// Cook's membrane: a tapered panel with corners (0, 0), (48, 44), (48, 60), (0, 44), clamped on
/// the left, a shear force of 1 for unit thickness spread over the right edge; plane stress, E = 1,
/// nu = 1/3. Deflection of (48, 52): 23.96 (Cook, Malkus & Plesha, "Concepts and Applications of
/// Finite Element Analysis"). Here as the half of a thin sheet above its middle plane.
TEST(CooksMembrane, DeflectsByTheKnownAmount) {
  constexpr double kHalfThickness = 0.5;
  const TetMesh mesh = MakeGrid({24, 24, 1}, ElementType::kTet10, [&](const Eigen::Vector3d& p) {
    return Eigen::Vector3d(48.0 * p[0], 44.0 * (p[0] + p[1]) - 28.0 * p[0] * p[1],
                           kHalfThickness * p[2]);
  });
  StaticProblem panel(
      mesh,
      {.model = MaterialModel::kLinear, .youngs_modulus_Pa = 1.0, .poissons_ratio = 1.0 / 3.0});
  panel.Fix([](const Eigen::Vector3d& p) { return p[0] < 1e-9; }, true, true, false);
  panel.Fix([](const Eigen::Vector3d& p) { return p[2] < 1e-9; }, false, false, true);
  panel.AddTraction([](const Eigen::Vector3d& p) { return p[0] > 48.0 - 1e-9; },
                    [](const Eigen::Vector3d&) { return Eigen::Vector3d(0.0, 1.0 / 16.0, 0.0); });
  const Solution solution = Solve(panel);
  ASSERT_TRUE(solution.result.status.ok()) << solution.result.status.message();
  EXPECT_NEAR(solution.Displacement(NearestNode(mesh, {48.0, 52.0, 0.0}))[1], 23.96, 0.03);
}

/// Cauchy stress of small-strain elasticity at a node, Pa: mean over the cells that share it.
Eigen::Matrix3d StressAtNode(const StaticProblem& problem, const Solution& solution, int node) {
  const Eigen::Matrix3Xd corners{{0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  int count = 0;
  for (int cell = 0; cell < problem.mesh.CellCount(); ++cell) {
    const Eigen::VectorXi nodes = problem.mesh.cells.col(cell);
    for (Eigen::Index k = 0; k < 4; ++k) {
      if (nodes[k] != node) continue;
      const Eigen::Matrix3Xd gradients =
          ShapeGradients(problem.mesh.element_type(), corners.col(k));
      const Eigen::Matrix3d jacobian =
          problem.mesh.nodes_m(Eigen::all, nodes) * gradients.transpose();
      const Eigen::Matrix3Xd moved = solution.u_m.reshaped(3, problem.mesh.NodeCount());
      const Eigen::Matrix3d slope =
          moved(Eigen::all, nodes) * gradients.transpose() * jacobian.inverse();
      const Eigen::Matrix3d strain = 0.5 * (slope + slope.transpose());
      sum += 2.0 * problem.material.LameMu_Pa() * strain +
             problem.material.LameLambda_Pa() * strain.trace() * Eigen::Matrix3d::Identity();
      ++count;
    }
  }
  return sum / count;
}

constexpr double kPlateHalf_m = 0.3;

/// A quarter of the plate of LE10, its hole and rim true ellipses; cells shrink towards D, at
/// (2, 0, 0.3) m. Edges are halved before they are bent: a grading of the mid-edge nodes too would
/// make quarter-point elements, singular at D.
TetMesh MakeLe10Plate(const Eigen::Array3i& cells) {
  TetMesh mesh = MakeQuadratic(MakeGrid(cells, ElementType::kTet4, [](const Eigen::Vector3d& p) {
    const double below_top = 2.0 * std::sqrt(2.0) * std::pow(1.0 - p[2], 1.5);
    return Eigen::Vector3d(p[0] * p[0], std::pow(p[1], 1.7),
                           p[2] > 0.5 ? 1.0 - below_top : 2.0 * p[2] - 1.0);
  }));
  for (auto p : mesh.nodes_m.colwise()) {
    const double angle = std::numbers::pi / 2.0 * p[1];
    p = Eigen::Vector3d((2.0 + 1.25 * p[0]) * std::cos(angle),
                        (1.0 + 1.75 * p[0]) * std::sin(angle), kPlateHalf_m * p[2]);
  }
  return mesh;
}

/// NAFEMS LE10, thick plate under pressure ("The Standard NAFEMS Benchmarks", rev. 3, 1990): a
/// quarter of an elliptic plate with an elliptic hole (half axes 3.25 x 2.75 and 2 x 1 m), 0.6 m
/// thick, 1 MPa on the upper face, E = 210 GPa, nu = 0.3; symmetry on the straight edges, the outer
/// face held in the plane, its middle line also across. sigma_yy at D, on the upper face where the
/// hole meets the x axis: -5.38 MPa.
TEST(NafemsLe10, StressAtTheHoleIsTheKnownOne) {
  const TetMesh mesh = MakeLe10Plate({12, 16, 6});
  const auto on_outer_face = [](const Eigen::Vector3d& p) {
    return std::abs(std::hypot(p[0] / 3.25, p[1] / 2.75) - 1.0) < 1e-9;
  };
  StaticProblem plate(
      mesh, {.model = MaterialModel::kLinear, .youngs_modulus_Pa = 210e9, .poissons_ratio = 0.3});
  plate.Fix([](const Eigen::Vector3d& p) { return p[1] < 1e-9; }, false, true, false);
  plate.Fix([](const Eigen::Vector3d& p) { return p[0] < 1e-9; }, true, false, false);
  plate.Fix(on_outer_face, true, true, false);
  plate.Fix([&](const Eigen::Vector3d& p) { return on_outer_face(p) && std::abs(p[2]) < 1e-9; },
            false, false, true);
  plate.AddTraction([&](const Eigen::Vector3d& p) { return p[2] > kPlateHalf_m - 1e-9; },
                    [](const Eigen::Vector3d&) { return Eigen::Vector3d(0.0, 0.0, -1e6); });
  const Solution solution = Solve(plate);
  ASSERT_TRUE(solution.result.status.ok()) << solution.result.status.message();
  const int node = NearestNode(mesh, {2.0, 0.0, kPlateHalf_m});
  EXPECT_NEAR(1e-6 * StressAtNode(plate, solution, node)(1, 1), -5.38, 0.005 * 5.38);
}

}  // namespace
}  // namespace palpate::fem::verification
