// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/libs/fem/verification/static_problem.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <utility>

#include "libs/fem/boundary_surface.hpp"
#include "libs/fem/shape_functions.hpp"

namespace palpate::fem::verification {

namespace {

struct TrianglePoint {
  double a, b, weight;
};

/// Exact for polynomials of degree 4 on the triangle (0,0), (1,0), (0,1) (Dunavant 1985, n = 4).
constexpr std::array<TrianglePoint, 6> kTriangleRule{{
    {0.445948490915965, 0.445948490915965, 0.223381589678011 / 2.0},
    {0.108103018168070, 0.445948490915965, 0.223381589678011 / 2.0},
    {0.445948490915965, 0.108103018168070, 0.223381589678011 / 2.0},
    {0.091576213509771, 0.091576213509771, 0.109951743655322 / 2.0},
    {0.816847572980459, 0.091576213509771, 0.109951743655322 / 2.0},
    {0.091576213509771, 0.816847572980459, 0.109951743655322 / 2.0},
}};

/// Shape functions and their derivatives along a and b of a face with 3 or 6 nodes (corners, then
/// edges 01, 12, 20): columns N, dN/da, dN/db.
Eigen::Matrix<double, Eigen::Dynamic, 3> FaceShape(Eigen::Index nodes, double a, double b) {
  const double c = 1.0 - a - b;
  Eigen::Matrix<double, Eigen::Dynamic, 3> shape(nodes, 3);
  if (nodes == 3) {
    shape << c, -1.0, -1.0, a, 1.0, 0.0, b, 0.0, 1.0;
    return shape;
  }
  shape << c * (2.0 * c - 1.0), 1.0 - 4.0 * c, 1.0 - 4.0 * c,  //
      a * (2.0 * a - 1.0), 4.0 * a - 1.0, 0.0,                 //
      b * (2.0 * b - 1.0), 0.0, 4.0 * b - 1.0,                 //
      4.0 * a * c, 4.0 * (c - a), -4.0 * a,                    //
      4.0 * a * b, 4.0 * b, 4.0 * a,                           //
      4.0 * b * c, -4.0 * b, 4.0 * (c - b);
  return shape;
}

}  // namespace

StaticProblem::StaticProblem(TetMesh body_mesh, const Material& body_material)
    : mesh(std::move(body_mesh)), material(body_material) {
  fixed = FixedDirections::Constant(3, mesh.NodeCount(), false);
  fixed_position_m = mesh.nodes_m.reshaped();
  external_force_N = Eigen::VectorXd::Zero(fixed_position_m.size());
}

void StaticProblem::Fix(const PointTest& test, bool x, bool y, bool z) {
  const Eigen::Array<bool, 3, 1> directions(x, y, z);
  for (int node : NodesWhere(mesh, test)) {
    fixed.col(node) = (fixed.col(node).array() || directions).matrix();
  }
}

void StaticProblem::Prescribe(const PointTest& test, const VectorField& position) {
  for (int node : NodesWhere(mesh, test)) {
    fixed.col(node).setConstant(true);
    fixed_position_m.segment<3>(3 * node) = position(mesh.nodes_m.col(node));
  }
}

void StaticProblem::AddTraction(const PointTest& test, const VectorField& traction_Pa) {
  const Eigen::MatrixXi faces = ExtractBoundary(mesh).faces;
  for (Eigen::Index f = 0; f < faces.cols(); ++f) {
    const Eigen::VectorXi nodes = faces.col(f);
    const Eigen::Matrix3Xd points = mesh.nodes_m(Eigen::all, nodes);
    const bool loaded = std::all_of(nodes.begin(), nodes.end(),
                                    [&](int node) { return test(mesh.nodes_m.col(node)); });
    if (!loaded) continue;
    for (const TrianglePoint& q : kTriangleRule) {
      const auto shape = FaceShape(nodes.size(), q.a, q.b);
      const Eigen::Vector3d along_a = points * shape.col(1);
      const Eigen::Vector3d along_b = points * shape.col(2);
      const double area = q.weight * along_a.cross(along_b).norm();
      const Eigen::Vector3d force = area * traction_Pa(points * shape.col(0));
      for (Eigen::Index k = 0; k < nodes.size(); ++k) {
        external_force_N.segment<3>(3 * nodes[k]) += shape(k, 0) * force;
      }
    }
  }
}

void StaticProblem::AddBodyForce(const VectorField& force_N_m3) {
  const TetQuadrature rule = FineQuadrature();
  for (int cell = 0; cell < mesh.CellCount(); ++cell) {
    const Eigen::VectorXi nodes = mesh.cells.col(cell);
    const Eigen::Matrix3Xd points = mesh.nodes_m(Eigen::all, nodes);
    for (Eigen::Index q = 0; q < rule.weights.size(); ++q) {
      const Eigen::VectorXd shape = ShapeFunctions(mesh.element_type(), rule.points.col(q));
      const Eigen::Matrix3d jacobian =
          points * ShapeGradients(mesh.element_type(), rule.points.col(q)).transpose();
      const Eigen::Vector3d force =
          rule.weights[q] * jacobian.determinant() * force_N_m3(points * shape);
      for (Eigen::Index k = 0; k < nodes.size(); ++k) {
        external_force_N.segment<3>(3 * nodes[k]) += shape[k] * force;
      }
    }
  }
}

Solution Solve(const StaticProblem& problem) { return SolveInSteps(problem, 1); }

Solution SolveInSteps(const StaticProblem& problem, int steps) {
  ElasticBody body(problem.mesh, {problem.material},
                   std::vector<int>(static_cast<size_t>(problem.mesh.CellCount()), 0),
                   problem.fibres);
  Linearisation linearisation(body, problem.constraints, problem.fixed);
  StaticSolver solver(linearisation);
  StaticState state = solver.RestState();
  Solution solution;
  for (int step = 1; step <= steps; ++step) {
    const double fraction = static_cast<double>(step) / steps;
    LoadState loads{fraction * problem.external_force_N, problem.commands,
                    problem.fixed_position_m};
    for (ConstraintCommand& command : loads.commands) command.value *= fraction;
    solution.result = solver.Solve(loads, &state);
    if (!solution.result.status.ok()) break;
  }
  solution.x_m = state.x_m;
  solution.u_m = state.x_m - body.rest_m();
  return solution;
}

}  // namespace palpate::fem::verification
