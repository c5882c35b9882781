// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <vector>

#include "libs/fem/shape_functions.hpp"
#include "tests/libs/fem/verification/static_problem.hpp"

namespace palpate::fem::verification {
namespace {

constexpr double kStep = 2e-3;  ///< of the difference stencil, over the edge of the unit cube

const Material kMaterial{
    .model = MaterialModel::kStableNeoHookean, .youngs_modulus_Pa = 1000.0, .poissons_ratio = 0.3};

/// The displacement that is to be the answer, m, on the unit cube; strains up to 25 %.
Eigen::Vector3d ExactDisplacement(const Eigen::Vector3d& p) {
  return {0.06 * std::sin(2.0 * p[0] + p[1]) * std::cos(p[2]),
          0.05 * std::cos(1.5 * p[1]) * std::sin(p[0] + 2.0 * p[2]),
          0.04 * std::sin(2.5 * p[2] + p[0]) * std::sin(1.0 + p[1])};
}

/// Derivative of f along axis i by central differences of sixth order.
template <typename Function>
auto Derivative(const Function& f, const Eigen::Vector3d& p, int i) {
  const Eigen::Vector3d h = kStep * Eigen::Vector3d::Unit(i);
  return ((45.0 * (f(p + h) - f(p - h)) - 9.0 * (f(p + 2 * h) - f(p - 2 * h)) +
           (f(p + 3 * h) - f(p - 3 * h))) /
          (60.0 * kStep))
      .eval();
}

Eigen::Matrix3d ExactGradient(const Eigen::Vector3d& p) {
  Eigen::Matrix3d gradient;
  for (int i = 0; i < 3; ++i) gradient.col(i) = Derivative(ExactDisplacement, p, i);
  return gradient;
}

/// First Piola-Kirchhoff stress of stable neo-Hookean (libs/fem/material.hpp), P = F S.
Eigen::Matrix3d ExactStress_Pa(const Eigen::Vector3d& p) {
  const Eigen::Matrix3d F = Eigen::Matrix3d::Identity() + ExactGradient(p);
  const double mu = kMaterial.LameMu_Pa();
  const double bulk = kMaterial.LameLambda_Pa() + mu;
  const double J = F.determinant();
  return mu * F + bulk * J * (J - 1.0 - mu / bulk) * F.inverse().transpose();
}

/// -Div P, the body force under which the exact displacement is the equilibrium.
Eigen::Vector3d BodyForce_N_m3(const Eigen::Vector3d& p) {
  Eigen::Vector3d divergence = Eigen::Vector3d::Zero();
  for (int i = 0; i < 3; ++i) divergence += Derivative(ExactStress_Pa, p, i).col(i);
  return -divergence;
}

struct ErrorNorms {
  double L2 = 0.0;  ///< of the displacement
  double H1 = 0.0;  ///< of its gradient
};

ErrorNorms MeasureErrors(const TetMesh& mesh, const Eigen::VectorXd& u_m) {
  const TetQuadrature rule = FineQuadrature();
  const Eigen::Matrix3Xd nodal_m = u_m.reshaped(3, mesh.NodeCount());
  ErrorNorms squares;
  for (int cell = 0; cell < mesh.CellCount(); ++cell) {
    const Eigen::VectorXi nodes = mesh.cells.col(cell);
    const Eigen::Matrix3Xd rest_m = mesh.nodes_m(Eigen::all, nodes);
    const Eigen::Matrix3Xd cell_u_m = nodal_m(Eigen::all, nodes);
    for (Eigen::Index q = 0; q < rule.weights.size(); ++q) {
      const Eigen::VectorXd shape = ShapeFunctions(mesh.element_type(), rule.points.col(q));
      const Eigen::Matrix3Xd slopes = ShapeGradients(mesh.element_type(), rule.points.col(q));
      const Eigen::Matrix3d jacobian = rest_m * slopes.transpose();
      const Eigen::Vector3d p = rest_m * shape;
      const double volume = rule.weights[q] * jacobian.determinant();
      squares.L2 += volume * (cell_u_m * shape - ExactDisplacement(p)).squaredNorm();
      squares.H1 +=
          volume *
          (cell_u_m * slopes.transpose() * jacobian.inverse() - ExactGradient(p)).squaredNorm();
    }
  }
  return {std::sqrt(squares.L2), std::sqrt(squares.H1)};
}

/// The surface of the unit cube held where the exact displacement puts it.
ErrorNorms SolveOn(int cells_per_edge, ElementType element) {
  StaticProblem cube(
      MakeBox(Eigen::Array3i::Constant(cells_per_edge), element, Eigen::Vector3d::Ones()),
      kMaterial);
  cube.Prescribe(
      [](const Eigen::Vector3d& p) { return p.minCoeff() < 1e-9 || p.maxCoeff() > 1.0 - 1e-9; },
      [](const Eigen::Vector3d& p) { return Eigen::Vector3d(p + ExactDisplacement(p)); });
  cube.AddBodyForce(BodyForce_N_m3);
  const Solution solution = Solve(cube);
  EXPECT_TRUE(solution.result.status.ok()) << solution.result.status.message();
  return MeasureErrors(cube.mesh, solution.u_m);
}

void ExpectOrders(ElementType element, int coarse_cells, double L2_order, double H1_order) {
  const ErrorNorms coarse = SolveOn(coarse_cells, element);
  const ErrorNorms fine = SolveOn(2 * coarse_cells, element);
  EXPECT_NEAR(std::log2(coarse.L2 / fine.L2), L2_order, 0.15);
  EXPECT_NEAR(std::log2(coarse.H1 / fine.H1), H1_order, 0.15);
}

TEST(ManufacturedSolution, LinearTetsConvergeWithOrdersTwoAndOne) {
  ExpectOrders(ElementType::kTet4, 6, 2.0, 1.0);
}

TEST(ManufacturedSolution, QuadraticTetsConvergeWithOrdersThreeAndTwo) {
  ExpectOrders(ElementType::kTet10, 4, 3.0, 2.0);
}

}  // namespace
}  // namespace palpate::fem::verification
