// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/shape_functions.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "tests/libs/fem/core/laws.hpp"

namespace palpate::fem {
namespace {

constexpr std::array<ElementType, 2> kElements{ElementType::kTet4, ElementType::kTet10};

double Factorial(int n) { return std::tgamma(n + 1.0); }

/// Nodes of the reference tetrahedron in the order of ElementType.
Eigen::Matrix3Xd ReferenceNodes(ElementType element) {
  Eigen::Matrix3Xd nodes = Eigen::Matrix3Xd::Zero(3, static_cast<int>(element));
  nodes.block<3, 3>(0, 1).setIdentity();
  if (element == ElementType::kTet4) return nodes;
  const int edges[6][2] = {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}};
  for (int e = 0; e < 6; ++e) {
    nodes.col(4 + e) = 0.5 * (nodes.col(edges[e][0]) + nodes.col(edges[e][1]));
  }
  return nodes;
}

TEST(ShapeFunctions, AreOneAtTheirOwnNodeAndZeroAtTheOthers) {
  for (const ElementType element : kElements) {
    const Eigen::Matrix3Xd nodes = ReferenceNodes(element);
    Eigen::MatrixXd values(nodes.cols(), nodes.cols());
    for (Eigen::Index a = 0; a < nodes.cols(); ++a) {
      values.col(a) = ShapeFunctions(element, nodes.col(a));
    }
    EXPECT_TRUE(values.isIdentity(1e-15)) << values;
  }
}

TEST(ShapeFunctions, AddUpToOneAndReproduceThePoint) {
  std::mt19937 engine(1);
  for (const ElementType element : kElements) {
    for (int trial = 0; trial < 20; ++trial) {
      const Eigen::Vector3d xi = laws::RandomVector(3, 1.0, &engine);
      const Eigen::VectorXd N = ShapeFunctions(element, xi);
      EXPECT_NEAR(N.sum(), 1.0, 1e-14);
      EXPECT_LE((ReferenceNodes(element) * N - xi).norm(), 1e-14);
      EXPECT_LE(ShapeGradients(element, xi).rowwise().sum().norm(), 1e-13);
    }
  }
}

TEST(ShapeFunctions, GradientsAreTheirDerivatives) {
  const Eigen::VectorXd xi = Eigen::Vector3d(0.2, 0.3, 0.15);
  for (const ElementType element : kElements) {
    const Eigen::Matrix3Xd dN = ShapeGradients(element, Eigen::Vector3d(xi));
    for (int i = 0; i < 3; ++i) {
      const Eigen::VectorXd expected = laws::DerivativeAlong(
          [&](const Eigen::VectorXd& x) { return ShapeFunctions(element, Eigen::Vector3d(x)); }, xi,
          Eigen::Vector3d::Unit(i), 1e-2);
      EXPECT_LE((dN.row(i).transpose() - expected).norm(), 1e-12);
    }
  }
}

/// Largest error over the monomials x^i y^j z^k of one degree; exact: i! j! k! / (i + j + k + 3)!.
double QuadratureError(const TetQuadrature& rule, int degree) {
  double largest = 0.0;
  for (int i = 0; i <= degree; ++i) {
    for (int j = 0; i + j <= degree; ++j) {
      const int k = degree - i - j;
      double sum = 0.0;
      for (Eigen::Index q = 0; q < rule.weights.size(); ++q) {
        const Eigen::Vector3d p = rule.points.col(q);
        sum += rule.weights[q] * std::pow(p.x(), i) * std::pow(p.y(), j) * std::pow(p.z(), k);
      }
      const double exact = Factorial(i) * Factorial(j) * Factorial(k) / Factorial(degree + 3);
      largest = std::max(largest, std::abs(sum - exact));
    }
  }
  return largest;
}

void ExpectExactUpTo(const TetQuadrature& rule, int degree) {
  for (int d = 0; d <= degree; ++d) EXPECT_LE(QuadratureError(rule, d), 1e-16) << "degree " << d;
  EXPECT_GT(QuadratureError(rule, degree + 1), 1e-6);
}

TEST(Quadrature, IsExactForItsDegree) {
  ExpectExactUpTo(StiffnessQuadrature(ElementType::kTet4), 1);
  ExpectExactUpTo(StiffnessQuadrature(ElementType::kTet10), 2);
  ExpectExactUpTo(FineQuadrature(), 4);
}

double CellVolume_m3(const TetMesh& mesh, int cell) {
  const Eigen::Matrix<double, 3, 4> corners =
      mesh.nodes_m(Eigen::all, mesh.cells.col(cell).head<4>());
  return (corners.rightCols<3>().colwise() - corners.col(0)).determinant() / 6.0;
}

TEST(ConsistentNodalMass, IsTheExactIntegralOnStraightCells) {
  const TetMesh tet4 = laws::CrookedBox(ElementType::kTet4, {2, 1, 1});
  for (const TetMesh& mesh : {tet4, MakeQuadratic(tet4)}) {
    Eigen::VectorXd density_kg_m3(mesh.CellCount());
    Eigen::VectorXd expected_kg = Eigen::VectorXd::Zero(mesh.NodeCount());
    double total_kg = 0.0;
    for (int cell = 0; cell < mesh.CellCount(); ++cell) {
      density_kg_m3[cell] = 900.0 + 20.0 * cell;
      const double mass_kg = density_kg_m3[cell] * CellVolume_m3(mesh, cell);
      total_kg += mass_kg;
      // Of the cell's mass a corner of tet4 has 1/4; of tet10 -1/20, a mid-edge node 1/5.
      for (Eigen::Index a = 0; a < mesh.cells.rows(); ++a) {
        const double share = mesh.cells.rows() == 4 ? 0.25 : a < 4 ? -0.05 : 0.2;
        expected_kg[mesh.cells(a, cell)] += share * mass_kg;
      }
    }
    const Eigen::VectorXd mass_kg = ConsistentNodalMass_kg(mesh, density_kg_m3);
    EXPECT_NEAR(mass_kg.sum(), total_kg, 1e-14 * total_kg);
    EXPECT_LE((mass_kg - expected_kg).cwiseAbs().maxCoeff(), 1e-15 * total_kg);
  }
}

TEST(ConsistentNodalMass, OfACurvedMeshOfABoxIsThatOfTheBox) {
  TetMesh mesh = MakeQuadratic(laws::CrookedBox(ElementType::kTet4, {2, 2, 2}));
  const Eigen::VectorXd density_kg_m3 = Eigen::VectorXd::Constant(mesh.CellCount(), 1000.0);
  const double straight_kg = ConsistentNodalMass_kg(mesh, density_kg_m3).sum();
  // The middle of the box lies on inner edges only: curving them moves mass between cells.
  Eigen::Index inner = 0;
  (mesh.nodes_m.rightCols(mesh.NodeCount() - 27).colwise() - Eigen::Vector3d::Constant(0.0075))
      .colwise()
      .squaredNorm()
      .minCoeff(&inner);
  mesh.nodes_m.col(27 + inner) += Eigen::Vector3d(4e-4, -3e-4, 2e-4);
  EXPECT_NEAR(ConsistentNodalMass_kg(mesh, density_kg_m3).sum(), straight_kg, 1e-14 * straight_kg);
}

}  // namespace
}  // namespace palpate::fem
