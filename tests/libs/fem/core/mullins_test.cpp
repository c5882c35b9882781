// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/mullins.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace palpate::fem {
namespace {

constexpr MullinsLaw kLaw{.r = 2.5, .m_J_m3 = 40.0};

TEST(Mullins, SoftensBelowTheLargestStrainByUpToOneOverR) {
  EXPECT_EQ(Damage(kLaw, 0.0), 1.0);
  EXPECT_NEAR(Damage(kLaw, 40.0), 1.0 - std::erf(1.0) / 2.5, 1e-15);
  double before = 1.0;
  for (const double below_J_m3 : {1.0, 10.0, 30.0, 100.0}) {
    const double eta = Damage(kLaw, below_J_m3);
    EXPECT_LT(eta, before) << below_J_m3;
    before = eta;
  }
  EXPECT_NEAR(Damage(kLaw, 1e6), 1.0 - 1.0 / 2.5, 1e-12);
}

TEST(Mullins, StepsOfAHeldBodyEndAtTheLaw) {
  const Eigen::Vector3d density_J_m3(5.0, 30.0, 80.0);
  Eigen::VectorXd largest_J_m3 = Eigen::Vector3d(50.0, 30.0, 20.0);
  Eigen::VectorXd damage = Eigen::Vector3d::Ones();
  double off = 1.0;
  for (int step = 0; step < 60; ++step) {
    const double next = StepDamage(kLaw, density_J_m3, &largest_J_m3, &damage);
    EXPECT_LE(next, off);
    off = next;
  }
  EXPECT_LT(off, 1e-6);
  EXPECT_EQ(largest_J_m3, Eigen::Vector3d(50.0, 30.0, 80.0));
  EXPECT_NEAR(damage[0], Damage(kLaw, 45.0), 1e-6);
  EXPECT_EQ(damage[1], 1.0);  // at its largest so far
  EXPECT_EQ(damage[2], 1.0);  // beyond it
}

TEST(Mullins, AVirginMaterialThatIsStrainedMoreAndMoreStaysVirgin) {
  Eigen::VectorXd largest_J_m3 = Eigen::VectorXd::Zero(1);
  Eigen::VectorXd damage = Eigen::VectorXd::Ones(1);
  for (double density_J_m3 = 0.0; density_J_m3 < 200.0; density_J_m3 += 7.0) {
    EXPECT_EQ(StepDamage(kLaw, Eigen::VectorXd::Constant(1, density_J_m3), &largest_J_m3, &damage),
              0.0);
  }
  EXPECT_EQ(damage[0], 1.0);
}

}  // namespace
}  // namespace palpate::fem
