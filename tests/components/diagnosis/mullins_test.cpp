// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <cmath>
#include <random>

#include "tests/components/diagnosis/hidden_faults.hpp"

namespace palpate::diagnosis {
namespace {

using Mullins = HiddenFaults;

constexpr double kSoftening = 0.25;
constexpr double kLnM = -0.4;  // about where m is searched
const Eigen::Vector2d kZ(kSoftening, kLnM);

TEST_F(Mullins, SoftensSoMuchAsItIsSaidToWhereMIsLookedFor) {
  const FaultModel& mullins = hypotheses_.model(Number("mullins", "body"));
  ModelHypothesis hypothesis = NominalHypothesis(body_, observed_);
  mullins.Apply(kZ, &hypothesis);
  ASSERT_TRUE(hypothesis.mullins);
  const double looked_for_J_m3 = mullins.parameters()[1].nominal;
  EXPECT_NEAR(
      hypothesis.mullins->inverse_r * std::erf(looked_for_J_m3 / hypothesis.mullins->m_J_m3),
      kSoftening, 1e-12);
  const auto report = mullins.Report(kZ, 1e-12 * Eigen::Matrix2d::Identity(), {});
  ASSERT_EQ(report.size(), 2U);
  EXPECT_EQ(report[0].name, "r");
  EXPECT_NEAR(report[0].value * hypothesis.mullins->inverse_r, 1.0, 1e-12);
  EXPECT_NEAR(report[0].ci95_low, report[0].value, 1e-4);
  EXPECT_NEAR(report[0].ci95_high, report[0].value, 1e-4);
  EXPECT_EQ(report[1].name, "m");
  EXPECT_NEAR(report[1].value, hypothesis.mullins->m_J_m3, 1e-9);
}

TEST_F(Mullins, HasNoRBelowOne) {
  const FaultModel& mullins = hypotheses_.model(Number("mullins", "body"));
  const Eigen::Vector2d more_than_can_be(0.9, 0.5);
  const auto report = mullins.Report(more_than_can_be, 1e-4 * Eigen::Matrix2d::Identity(), {});
  EXPECT_EQ(report[0].value, 1.0);
  EXPECT_GE(report[0].ci95_high, 1.0);
  EXPECT_NEAR(report[0].ci95_low, 1.0, 1e-9);
}

TEST_F(Mullins, HasIntervalsOfAsMuchAsIsBelieved) {
  constexpr int kDraws = 100000;
  const FaultModel& mullins = hypotheses_.model(Number("mullins", "body"));
  Eigen::Matrix2d root;
  root << 0.02, 0.0, -0.1, 0.2;
  const auto report = mullins.Report(kZ, root * root.transpose(), {});
  std::mt19937 random(kSeed);
  std::normal_distribution<double> normal;
  int below = 0;
  int above = 0;
  for (int k = 0; k < kDraws; ++k) {
    const double first = normal(random);
    const double second = normal(random);
    const Eigen::Vector2d z = kZ + root * Eigen::Vector2d(first, second);
    const double r = std::erf(std::exp(-z[1])) / z[0];
    below += r < report[0].ci95_low;
    above += r > report[0].ci95_high;
  }
  // 2.5 % give or take five sigma of what so many draws scatter by.
  const double wanted = 0.025 * kDraws;
  EXPECT_NEAR(below, wanted, 5.0 * std::sqrt(wanted)) << "seed " << kSeed;
  EXPECT_NEAR(above, wanted, 5.0 * std::sqrt(wanted)) << "seed " << kSeed;
}

}  // namespace
}  // namespace palpate::diagnosis
