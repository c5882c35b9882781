// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/point_stress.hpp"

#include <gtest/gtest.h>

#include "libs/fem/elastic_body.hpp"
#include "tests/libs/fem/core/laws.hpp"

namespace palpate::fem {
namespace {

using laws::AllLaws;
using laws::CrookedBox;
using laws::Law;
using laws::RandomVector;
using laws::Rotation;

std::vector<Law> TurnableLaws() {
  std::vector<Law> turnable;
  for (const Law& law : AllLaws()) {
    if (law.model != MaterialModel::kLinear) turnable.push_back(law);
  }
  return turnable;
}

class PointStressLaw : public ::testing::TestWithParam<Law> {
 protected:
  PointStressLaw() {
    for (size_t cell = 0; cell < material_of_cell_.size(); ++cell) {
      material_of_cell_[cell] = cell % 3 == 0 ? 1 : 0;
    }
    factor_ = Eigen::VectorXd::LinSpaced(mesh_.CellCount(), 0.7, 1.4);
  }

  Material OfModulus(double youngs_modulus_Pa) const {
    return {GetParam().model, GetParam().volumetric, youngs_modulus_Pa, 0.45, -0.1, 0.2};
  }

  /// Of the stresses at x_m_, which are given back.
  NodeMatrix MatrixOfThePresent(const PointStress& points,
                                Eigen::Matrix<double, 6, Eigen::Dynamic>* stress_Pa) const {
    points.Evaluate(materials_, factor_, x_m_, stress_Pa);
    NodeMatrix matrix(mesh_);
    points.SetMatrix(*stress_Pa, &matrix);
    return matrix;
  }

  TetMesh mesh_ = CrookedBox(GetParam().element, {2, 1, 1});
  std::vector<Material> materials_{OfModulus(180e3), OfModulus(60e3)};
  std::vector<int> material_of_cell_ = std::vector<int>(static_cast<size_t>(mesh_.CellCount()));
  Eigen::VectorXd factor_;
  std::mt19937 engine_{5};
  Eigen::VectorXd x_m_ = Eigen::VectorXd(mesh_.nodes_m.reshaped()) +
                         RandomVector(3 * mesh_.NodeCount(), 3e-4, &engine_);
};

TEST_P(PointStressLaw, MatrixOfThePresentStressGivesTheElasticForces) {
  const PointStress points(mesh_, material_of_cell_);
  Eigen::Matrix<double, 6, Eigen::Dynamic> stress_Pa;
  const NodeMatrix matrix = MatrixOfThePresent(points, &stress_Pa);
  Eigen::VectorXd force_N = Eigen::VectorXd::Zero(x_m_.size());
  matrix.AddProduct(x_m_, 1.0, force_N);

  ElasticBody body(mesh_, materials_, material_of_cell_);
  body.SetCellFactors(factor_);
  Eigen::VectorXd expected_N = Eigen::VectorXd::Zero(x_m_.size());
  body.AddForces(x_m_, expected_N);
  EXPECT_LE((force_N - expected_N).norm(), 1e-10 * expected_N.norm());
}

TEST_P(PointStressLaw, ForcesOfAKeptStressAreThoseOfItsMatrix) {
  const PointStress points(mesh_, material_of_cell_);
  Eigen::Matrix<double, 6, Eigen::Dynamic> stress_Pa;
  const NodeMatrix matrix = MatrixOfThePresent(points, &stress_Pa);
  const Eigen::VectorXd later_m = x_m_ + RandomVector(x_m_.size(), 2e-3, &engine_);
  Eigen::VectorXd force_N = RandomVector(x_m_.size(), 1.0, &engine_);
  Eigen::VectorXd expected_N = force_N;
  matrix.AddProduct(later_m, 1.0, expected_N);
  points.AddForces(stress_Pa, later_m, &force_N);
  EXPECT_LE((force_N - expected_N).norm(), 1e-12 * expected_N.norm());
}

TEST_P(PointStressLaw, RotationDoesNotChangeIt) {
  const PointStress points(mesh_, material_of_cell_);
  const Eigen::Matrix3d R = Rotation(2.1, Eigen::Vector3d(1.0, -2.0, 0.5));
  const Eigen::VectorXd turned_m = (R * x_m_.reshaped(3, mesh_.NodeCount())).reshaped();
  Eigen::Matrix<double, 6, Eigen::Dynamic> before_Pa;
  Eigen::Matrix<double, 6, Eigen::Dynamic> after_Pa;
  points.Evaluate(materials_, factor_, x_m_, &before_Pa);
  points.Evaluate(materials_, factor_, turned_m, &after_Pa);
  EXPECT_LE((after_Pa - before_Pa).norm(), 1e-10 * before_Pa.norm());
}

TEST(PointStress, OfALinearMaterialGivesItsForcesToFirstOrder) {
  const TetMesh mesh = CrookedBox(ElementType::kTet10, {2, 1, 1});
  const std::vector<int> material_of_cell(static_cast<size_t>(mesh.CellCount()), 0);
  const std::vector<Material> materials{
      {MaterialModel::kLinear, Volumetric::kPointwise, 180e3, 0.4, 0.0, 0.0}};
  const PointStress points(mesh, material_of_cell);
  const ElasticBody body(mesh, materials, material_of_cell);
  std::mt19937 engine(5);
  const Eigen::VectorXd rest_m = mesh.nodes_m.reshaped();
  const Eigen::VectorXd direction = RandomVector(rest_m.size(), 1.0, &engine);
  const auto off = [&](double size_m) {
    const Eigen::VectorXd x_m = rest_m + size_m * direction;
    Eigen::Matrix<double, 6, Eigen::Dynamic> stress_Pa;
    points.Evaluate(materials, Eigen::VectorXd::Ones(mesh.CellCount()), x_m, &stress_Pa);
    Eigen::VectorXd force_N = Eigen::VectorXd::Zero(x_m.size());
    points.AddForces(stress_Pa, x_m, &force_N);
    Eigen::VectorXd expected_N = Eigen::VectorXd::Zero(x_m.size());
    body.AddForces(x_m, expected_N);
    return (force_N - expected_N).norm() / expected_N.norm();
  };
  EXPECT_LE(off(1e-6), 2e-3);
  EXPECT_NEAR(off(1e-6) / off(1e-7), 10.0, 1.0);
}

INSTANTIATE_TEST_SUITE_P(Laws, PointStressLaw, ::testing::ValuesIn(TurnableLaws()),
                         [](const auto& law) { return laws::Name(law.param); });

}  // namespace
}  // namespace palpate::fem
