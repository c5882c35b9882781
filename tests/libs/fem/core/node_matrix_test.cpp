// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/node_matrix.hpp"

#include <gtest/gtest.h>

#include "libs/fem/linearisation.hpp"
#include "libs/fem/shape_functions.hpp"
#include "libs/linalg/symmetric_eigen.hpp"
#include "tests/libs/fem/core/laws.hpp"

namespace palpate::fem {
namespace {

using laws::CrookedBox;
using laws::RandomVector;

NodePairs AllPairs(const TetMesh& mesh) {
  NodePairs pairs;
  for (int cell = 0; cell < mesh.CellCount(); ++cell) {
    for (Eigen::Index a = 1; a < mesh.cells.rows(); ++a) {
      for (Eigen::Index b = 0; b < a; ++b) {
        pairs.emplace_back(mesh.cells(a, cell), mesh.cells(b, cell));
      }
    }
  }
  return pairs;
}

Eigen::MatrixXd Dense(const NodeMatrix& matrix) {
  const Eigen::Index size = 3 * matrix.NodeCount();
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(size, size);
  for (Eigen::Index k = 0; k < size; ++k) {
    Eigen::VectorXd column = Eigen::VectorXd::Zero(size);
    matrix.AddProduct(Eigen::VectorXd::Unit(size, k), 1.0, column);
    dense.col(k) = column;
  }
  return dense;
}

class NodeMatrixOf : public ::testing::TestWithParam<ElementType> {
 protected:
  NodeMatrixOf() {
    AddConsistentMass(mesh_, Eigen::VectorXd::LinSpaced(mesh_.CellCount(), 900.0, 1300.0), &mass_);
  }

  TetMesh mesh_ = CrookedBox(GetParam(), {2, 1, 1});
  NodeMatrix mass_{mesh_};
};

TEST_P(NodeMatrixOf, MassIsSymmetricAndPositive) {
  const Eigen::MatrixXd dense = Dense(mass_);
  EXPECT_LE((dense - dense.transpose()).cwiseAbs().maxCoeff(), 1e-18);
  EXPECT_GT(linalg::SymmetricEigenvalues(dense).minCoeff(), 0.0);
}

TEST_P(NodeMatrixOf, MassOfAUniformMotionIsTheNodesShareInTheWeight) {
  const Eigen::VectorXd share_kg =
      ConsistentNodalMass_kg(mesh_, Eigen::VectorXd::LinSpaced(mesh_.CellCount(), 900.0, 1300.0));
  const Eigen::Vector3d along(1.0, -2.0, 0.5);
  Eigen::VectorXd force = Eigen::VectorXd::Zero(3 * mesh_.NodeCount());
  mass_.AddProduct(along.replicate(mesh_.NodeCount(), 1), 1.0, force);
  for (int node = 0; node < mesh_.NodeCount(); ++node) {
    EXPECT_LE((force.segment<3>(3 * node) - share_kg[node] * along).norm(), 1e-15);
  }
}

TEST_P(NodeMatrixOf, QuadraticIsTwiceTheKineticEnergy) {
  std::mt19937 engine{7};
  const Eigen::VectorXd v = RandomVector(3 * mesh_.NodeCount(), 1.0, &engine);
  EXPECT_NEAR(mass_.Quadratic(v), v.dot(Dense(mass_) * v), 1e-12 * mass_.Quadratic(v));
}

TEST_P(NodeMatrixOf, AddsItselfToTheFreePartOfAStiffnessMatrix) {
  FixedDirections fixed = FixedDirections::Constant(3, mesh_.NodeCount(), false);
  fixed.col(1).setConstant(true);
  StiffnessMatrix stiffness(fixed, AllPairs(mesh_));
  mass_.BindTo(stiffness);
  mass_.AddTo(2.0, stiffness);
  std::mt19937 engine{8};
  Eigen::VectorXd motion = RandomVector(3 * mesh_.NodeCount(), 1.0, &engine);
  motion.segment<3>(3).setZero();
  Eigen::VectorXd expected = Eigen::VectorXd::Zero(motion.size());
  mass_.AddProduct(motion, 2.0, expected);
  Eigen::VectorXd reduced_motion(stiffness.Size());
  Eigen::VectorXd reduced_expected(stiffness.Size());
  stiffness.Reduce(motion, reduced_motion);
  stiffness.Reduce(expected, reduced_expected);
  EXPECT_LE((stiffness.Times(reduced_motion) - reduced_expected).norm(),
            1e-14 * reduced_expected.norm());
}

TEST_P(NodeMatrixOf, AnAddedPointMassWeighsAsMuch) {
  const double before_kg =
      mass_.Quadratic(Eigen::Vector3d::UnitX().replicate(mesh_.NodeCount(), 1));
  const int a = mesh_.cells(0, 0);
  const int b = mesh_.cells(1, 0);
  mass_.Add(a, a, 0.25);
  mass_.Add(a, b, 0.25);
  mass_.Add(b, b, 0.25);
  EXPECT_NEAR(mass_.Quadratic(Eigen::Vector3d::UnitX().replicate(mesh_.NodeCount(), 1)),
              before_kg + 1.0, 1e-12);
}

INSTANTIATE_TEST_SUITE_P(Elements, NodeMatrixOf,
                         ::testing::Values(ElementType::kTet4, ElementType::kTet10));

}  // namespace
}  // namespace palpate::fem
