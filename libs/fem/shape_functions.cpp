// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/shape_functions.hpp"

#include <Eigen/LU>
#include <array>
#include <cmath>

#include "libs/core/index.hpp"

namespace palpate::fem {

namespace {

/// Corners that each mid-edge node lies between, in the order of ElementType::kTet10.
constexpr std::array<std::array<int, 2>, 6> kReferenceEdges{
    {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}}};

Eigen::Vector4d Barycentric(const Eigen::Vector3d& xi) {
  return {1.0 - xi.sum(), xi.x(), xi.y(), xi.z()};
}

/// [3 x 4] derivatives of the barycentric coordinates.
Eigen::Matrix<double, 3, 4> BarycentricGradients() {
  Eigen::Matrix<double, 3, 4> gradients;
  gradients.col(0).setConstant(-1.0);
  gradients.rightCols<3>().setIdentity();
  return gradients;
}

}  // namespace

Eigen::VectorXd ShapeFunctions(ElementType type, const Eigen::Vector3d& xi) {
  const Eigen::Vector4d L = Barycentric(xi);
  if (type == ElementType::kTet4) return L;
  Eigen::VectorXd N(10);
  for (int a = 0; a < 4; ++a) N[a] = L[a] * (2.0 * L[a] - 1.0);
  for (int e = 0; e < 6; ++e) {
    const auto [i, j] = kReferenceEdges[At(e)];
    N[4 + e] = 4.0 * L[i] * L[j];
  }
  return N;
}

Eigen::Matrix3Xd ShapeGradients(ElementType type, const Eigen::Vector3d& xi) {
  const Eigen::Vector4d L = Barycentric(xi);
  const Eigen::Matrix<double, 3, 4> dL = BarycentricGradients();
  if (type == ElementType::kTet4) return dL;
  Eigen::Matrix3Xd dN(3, 10);
  for (int a = 0; a < 4; ++a) dN.col(a) = (4.0 * L[a] - 1.0) * dL.col(a);
  for (int e = 0; e < 6; ++e) {
    const auto [i, j] = kReferenceEdges[At(e)];
    dN.col(4 + e) = 4.0 * (L[i] * dL.col(j) + L[j] * dL.col(i));
  }
  return dN;
}

TetQuadrature StiffnessQuadrature(ElementType type) {
  if (type == ElementType::kTet4) {
    return {Eigen::Vector3d::Constant(0.25), Eigen::VectorXd::Constant(1, 1.0 / 6.0)};
  }
  const double a = (5.0 - std::sqrt(5.0)) / 20.0;
  const double b = 1.0 - 3.0 * a;
  TetQuadrature rule{Eigen::Matrix3Xd::Constant(3, 4, a), Eigen::VectorXd::Constant(4, 1.0 / 24.0)};
  for (int k = 0; k < 3; ++k) rule.points(k, k + 1) = b;
  return rule;
}

TetQuadrature FineQuadrature() {
  // Keast's rule of degree 4 with 11 points.
  TetQuadrature rule{Eigen::Matrix3Xd(3, 11), Eigen::VectorXd(11)};
  const double a = 1.0 / 14.0;
  const double b = 11.0 / 14.0;
  const double c = (1.0 + std::sqrt(5.0 / 14.0)) / 4.0;
  const double d = 0.5 - c;
  rule.points.col(0).setConstant(0.25);
  rule.points.block<3, 4>(0, 1).setConstant(a);
  for (int k = 0; k < 3; ++k) rule.points(k, k + 1) = b;
  rule.points.rightCols<6>() << c, c, d, d, d, c,  //
      c, d, c, d, c, d,                            //
      d, c, c, c, d, d;
  rule.weights << -74.0 / 5625.0, Eigen::VectorXd::Constant(4, 343.0 / 45000.0),
      Eigen::VectorXd::Constant(6, 56.0 / 2250.0);
  return rule;
}

Eigen::VectorXd ConsistentNodalMass_kg(const TetMesh& mesh, const Eigen::VectorXd& density_kg_m3) {
  const TetQuadrature rule = FineQuadrature();
  Eigen::VectorXd mass = Eigen::VectorXd::Zero(mesh.NodeCount());
  const auto nodes_per_cell = mesh.cells.rows();
  for (int cell = 0; cell < mesh.CellCount(); ++cell) {
    Eigen::Matrix3Xd corners(3, nodes_per_cell);
    for (int a = 0; a < nodes_per_cell; ++a) corners.col(a) = mesh.nodes_m.col(mesh.cells(a, cell));
    for (int q = 0; q < rule.weights.size(); ++q) {
      const Eigen::Vector3d xi = rule.points.col(q);
      const Eigen::Matrix3d jacobian =
          corners * ShapeGradients(mesh.element_type(), xi).transpose();
      const double scale = density_kg_m3[cell] * rule.weights[q] * jacobian.determinant();
      const Eigen::VectorXd N = ShapeFunctions(mesh.element_type(), xi);
      for (int a = 0; a < nodes_per_cell; ++a) mass[mesh.cells(a, cell)] += scale * N[a];
    }
  }
  return mass;
}

}  // namespace palpate::fem
