// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include "libs/fem/elastic_body.hpp"
#include "tests/libs/fem/core/laws.hpp"

namespace palpate::fem {
namespace {

using laws::CrookedBox;
using laws::RandomVector;

class CellFactors : public ::testing::TestWithParam<ElementType> {
 protected:
  const TetMesh mesh_ = CrookedBox(GetParam(), {2, 1, 1});
  const Material material_{MaterialModel::kNeoHookean, Volumetric::kPointwise, 1e5, 0.4};
  ElasticBody body_{mesh_, {material_}, std::vector<int>(static_cast<size_t>(mesh_.CellCount()))};
  std::mt19937 engine_{5};
  Eigen::VectorXd x_m_ = body_.rest_m() + RandomVector(body_.rest_m().size(), 3e-4, &engine_);
};

TEST_P(CellFactors, ScaleTheEnergyOfEachCell) {
  Eigen::VectorXd plain_J;
  Eigen::VectorXd scaled_J;
  const double min_J = body_.CellEnergies(x_m_, &plain_J);
  const Eigen::VectorXd factor = Eigen::VectorXd::LinSpaced(mesh_.CellCount(), 0.5, 2.0);
  body_.SetCellFactors(factor);
  EXPECT_EQ(body_.CellEnergies(x_m_, &scaled_J), min_J);
  EXPECT_LE((scaled_J - factor.cwiseProduct(plain_J)).cwiseAbs().maxCoeff(),
            1e-13 * plain_J.maxCoeff());
}

TEST_P(CellFactors, EnergiesOfTheCellsAddUpToTheBodys) {
  Eigen::VectorXd energy_J;
  double min_J = 0.0;
  EXPECT_EQ(body_.CellEnergies(x_m_, &energy_J), [&] {
    body_.Energy(x_m_, &min_J);
    return min_J;
  }());
  EXPECT_NEAR(energy_J.sum(), body_.Energy(x_m_, &min_J), 1e-13 * energy_J.sum());
}

TEST_P(CellFactors, OfOneEverywhereChangeNoBit) {
  Eigen::VectorXd before_N = Eigen::VectorXd::Zero(x_m_.size());
  Eigen::VectorXd after_N = before_N;
  body_.AddForces(x_m_, before_N);
  body_.SetCellFactors(Eigen::VectorXd::Ones(mesh_.CellCount()));
  body_.AddForces(x_m_, after_N);
  EXPECT_EQ(before_N, after_N);
}

INSTANTIATE_TEST_SUITE_P(Elements, CellFactors,
                         ::testing::Values(ElementType::kTet4, ElementType::kTet10));

}  // namespace
}  // namespace palpate::fem
