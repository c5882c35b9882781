// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/cell_stress.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/libs/fem/core/laws.hpp"
#include "tests/libs/fem/points/meshes.hpp"

namespace palpate::fem {
namespace {

class CellStressOf : public ::testing::TestWithParam<ElementType> {
 protected:
  static TetMesh Mesh() {
    const TetMesh box = BoxMesh({0.03, 0.02, 0.01}, {3, 2, 1});
    return GetParam() == ElementType::kTet4 ? box : MakeQuadratic(box);
  }
  CellStress Under(const Eigen::Matrix3d& F) const {
    const Eigen::Matrix3Xd moved_m = F * mesh_.nodes_m;
    return EvaluateCellStress(mesh_, {material_}, material_of_cell_, moved_m.reshaped());
  }

  TetMesh mesh_ = Mesh();
  Material material_{MaterialModel::kStVenantKirchhoff, Volumetric::kPointwise, 100e3, 0.3};
  std::vector<int> material_of_cell_ = std::vector<int>(static_cast<size_t>(mesh_.CellCount()), 0);
};

TEST_P(CellStressOf, ASmallPullIsYoungsModulusTimesStrain) {
  constexpr double kStrain = 1e-5;
  const CellStress stress =
      Under(Eigen::Vector3d(1.0 + kStrain, 1.0 - 0.3 * kStrain, 1.0 - 0.3 * kStrain).asDiagonal());
  ASSERT_EQ(stress.von_mises_Pa.size(), mesh_.CellCount());
  for (int cell = 0; cell < mesh_.CellCount(); ++cell) {
    EXPECT_NEAR(stress.von_mises_Pa[cell], 100e3 * kStrain, 1e-4);
    EXPECT_NEAR(stress.largest_strain[cell], kStrain, 1e-12);
  }
}

TEST_P(CellStressOf, ALargePullHasTheCauchyStressOfItsLaw) {
  // S = lambda tr(E) I + 2 mu E with E = (F'F - I) / 2; sigma = F S F' / J.
  const Eigen::Vector3d stretch(1.4, 0.9, 0.8);
  const Eigen::Vector3d E = 0.5 * (stretch.array().square() - 1.0);
  const Eigen::Vector3d S = material_.LameLambda_Pa() * E.sum() * Eigen::Vector3d::Ones() +
                            2.0 * material_.LameMu_Pa() * E;
  const Eigen::Vector3d cauchy_Pa =
      (stretch.array().square() * S.array() / stretch.prod()).matrix();
  const double von_mises_Pa = std::sqrt(0.5 * (std::pow(cauchy_Pa[0] - cauchy_Pa[1], 2) +
                                               std::pow(cauchy_Pa[1] - cauchy_Pa[2], 2) +
                                               std::pow(cauchy_Pa[2] - cauchy_Pa[0], 2)));
  const CellStress stress = Under(stretch.asDiagonal());
  EXPECT_NEAR(stress.von_mises_Pa.minCoeff(), von_mises_Pa, 1e-8 * von_mises_Pa);
  EXPECT_NEAR(stress.von_mises_Pa.maxCoeff(), von_mises_Pa, 1e-8 * von_mises_Pa);
  EXPECT_NEAR(stress.largest_strain.maxCoeff(), 0.4, 1e-12);
}

TEST_P(CellStressOf, ARotationChangesNothing) {
  const Eigen::Matrix3d R = laws::Rotation(1.1, Eigen::Vector3d(1, 2, 3).normalized());
  const CellStress rotated = Under(R);
  EXPECT_LT(rotated.von_mises_Pa.maxCoeff(), 1e-6);
  EXPECT_LT(rotated.largest_strain.cwiseAbs().maxCoeff(), 1e-12);
  Eigen::Matrix3d F;
  F << 1.1, 0.2, 0.0, 0.0, 0.9, 0.1, -0.1, 0.0, 1.0;
  const CellStress before = Under(F);
  const CellStress after = Under(R * F);
  EXPECT_TRUE(after.von_mises_Pa.isApprox(before.von_mises_Pa, 1e-9));
  EXPECT_TRUE(after.largest_strain.isApprox(before.largest_strain, 1e-9));
}

INSTANTIATE_TEST_SUITE_P(Elements, CellStressOf,
                         ::testing::Values(ElementType::kTet4, ElementType::kTet10));

}  // namespace
}  // namespace palpate::fem
