// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "components/force_estimation/shape/false_alarm.hpp"
#include "libs/core/statistics.hpp"

namespace palpate::force_estimation {
namespace {

constexpr Eigen::Index kRows = 25;

/// Tests along a smooth closed curve: each is like its neighbours.
Eigen::MatrixXd SmoothDirections(Eigen::Index count) {
  Eigen::MatrixXd directions(kRows, count);
  for (Eigen::Index c = 0; c < count; ++c) {
    const double angle = 2.0 * M_PI * static_cast<double>(c) / static_cast<double>(count);
    for (Eigen::Index i = 0; i < kRows; ++i) {
      directions(i, c) = std::exp(2.0 * std::cos(angle - 0.25 * static_cast<double>(i)));
    }
  }
  directions.colwise().normalize();
  return directions;
}

Eigen::VectorXd Noise(std::mt19937& random) {
  std::normal_distribution<double> normal;
  Eigen::VectorXd noise(kRows);
  for (double& value : noise) value = normal(random);
  return noise;
}

TEST(FalseAlarm, ThresholdIsExceededAsOftenAsAskedFor) {
  const Eigen::MatrixXd directions = SmoothDirections(200);
  FalseAlarm false_alarm;
  for (const double significance : {0.1, 0.01}) {
    const double threshold = false_alarm.Threshold(directions, significance);
    std::mt19937 random(3);
    constexpr int kDraws = 20000;
    int alarms = 0;
    for (int draw = 0; draw < kDraws; ++draw) {
      alarms += (directions.transpose() * Noise(random)).maxCoeff() > threshold ? 1 : 0;
    }
    EXPECT_GT(alarms, 0.8 * significance * kDraws) << significance;
    EXPECT_LT(alarms, 1.2 * significance * kDraws) << significance;
  }
}

TEST(FalseAlarm, OneTestHasItsOwnChance) {
  FalseAlarm false_alarm;
  const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(kRows, 1);
  EXPECT_NEAR(false_alarm.Chance(one, 3.0), NormalTail(3.0), 1e-12);
  EXPECT_NEAR(false_alarm.Threshold(one, 1e-6), NormalQuantile(1.0 - 1e-6), 1e-6);
}

TEST(FalseAlarm, CopiesOfOneTestCountOnce) {
  FalseAlarm false_alarm;
  const Eigen::MatrixXd copies = Eigen::VectorXd::Unit(kRows, 4).replicate(1, 40);
  EXPECT_NEAR(false_alarm.Chance(copies, 4.0), NormalTail(4.0), 1e-3 * NormalTail(4.0));
}

TEST(FalseAlarm, IndependentTestsAddUp) {
  FalseAlarm false_alarm;
  const Eigen::MatrixXd independent = Eigen::MatrixXd::Identity(kRows, kRows);
  const double all = 1.0 - std::pow(1.0 - NormalTail(3.0), kRows);
  EXPECT_NEAR(false_alarm.Chance(independent, 3.0), all, 0.05 * all);
  EXPECT_NEAR(false_alarm.Chance(independent, 6.0), kRows * NormalTail(6.0),
              1e-3 * kRows * NormalTail(6.0));
}

TEST(FalseAlarm, SignificantAgreesWithTheChance) {
  FalseAlarm false_alarm;
  const Eigen::MatrixXd directions = SmoothDirections(100);
  for (double t = 0.5; t < 8.0; t += 0.25) {
    EXPECT_EQ(false_alarm.Significant(directions, t, 1e-3),
              false_alarm.Chance(directions, t) < 1e-3)
        << t;
  }
}

}  // namespace
}  // namespace palpate::force_estimation
