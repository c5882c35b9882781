// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/core/statistics.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

namespace palpate {
namespace {

TEST(Statistics, TheMedianOfAnEvenNumberIsTheMeanOfTheMiddleTwo) {
  EXPECT_EQ(Median({3.0, 1.0, 2.0}), 2.0);
  EXPECT_EQ(Median({4.0, 1.0, 3.0, 2.0}), 2.5);
  EXPECT_EQ(Median({2.0, 2.0}), 2.0);
  EXPECT_TRUE(std::isnan(Median({})));
}

TEST(Statistics, TheUpperMedianIsAValueOfTheSample) {
  std::vector<double> four = {4.0, 1.0, 3.0, 2.0};
  EXPECT_EQ(UpperMedian(four), 3.0);
  std::vector<float> three = {3.0f, 1.0f, 2.0f};
  EXPECT_EQ(UpperMedian(three), 2.0f);
  std::vector<int> many = {9, 0, 7, 5, 9};
  EXPECT_EQ(UpperMedian(std::span(many).first(3)), 7);
}

/// Of 1, 2, ... n the quantile is floor(share n) + 1, at most n.
TEST(Statistics, QuantilesAreValuesOfTheSample) {
  EXPECT_EQ(Quantile({4.0, 1.0, 3.0, 2.0}, 0.0), 1.0);
  EXPECT_EQ(Quantile({4.0, 1.0, 3.0, 2.0}, 0.24), 1.0);
  EXPECT_EQ(Quantile({4.0, 1.0, 3.0, 2.0}, 0.25), 2.0);
  EXPECT_EQ(Quantile({4.0, 1.0, 3.0, 2.0}, 0.5), 3.0);
  EXPECT_EQ(Quantile({4.0, 1.0, 3.0, 2.0}, 1.0), 4.0);
  EXPECT_EQ(Quantile({5.0}, 0.99), 5.0);
  EXPECT_TRUE(std::isnan(Quantile({}, 0.5)));
}

TEST(Statistics, TheMeanOfNothingIsNotANumber) {
  EXPECT_EQ(Mean({1.0, 2.0, 6.0}), 3.0);
  EXPECT_TRUE(std::isnan(Mean({})));
}

/// The weight times the residual is the derivative of Huber's loss: r, then the threshold.
TEST(Statistics, HubersWeightBoundsTheInfluenceOfAResidual) {
  EXPECT_EQ(HuberWeight(0.0, 2.0), 1.0);
  EXPECT_EQ(HuberWeight(2.0, 2.0), 1.0);
  for (const double norm : {2.1, 5.0, 1e6}) EXPECT_DOUBLE_EQ(HuberWeight(norm, 2.0) * norm, 2.0);
  EXPECT_EQ(HuberWeight(1e6, 0.0), 1.0);
  EXPECT_EQ(HuberWeight(std::numeric_limits<double>::infinity(), 2.0), 0.0);
}

TEST(Statistics, NormalQuantileInvertsTheDistribution) {
  for (const double z :
       {-6.0, -3.0, -1.959963984540054, -0.5, 0.0, 0.1, 1.0, 2.5758293035489, 5.0}) {
    const double probability = 0.5 * std::erfc(-z / std::sqrt(2.0));
    EXPECT_NEAR(NormalQuantile(probability), z, 2e-8 * (1.0 + std::abs(z))) << z;
  }
  EXPECT_NEAR(NormalQuantile(0.975), kSigmas95, 1e-8);
  EXPECT_NEAR(NormalQuantile(0.025), -kSigmas95, 1e-8);
  EXPECT_DOUBLE_EQ(kSigmas95InPlane, std::sqrt(ChiSquaredQuantile(0.95, 2)));
}

/// Chances that the settings permit, of which 1 - chance is 1.
TEST(Statistics, QuantilesOfTheSmallestChancesAreFiniteAndNoSmallerThanThoseOfLarger) {
  double normal = 0.0;
  std::array<double, 4> chi_squared = {};
  for (const double chance : {1e-6, 1e-12, 1e-15, 1e-17, 1e-300}) {
    const double next = NormalQuantile(1.0 - chance);
    EXPECT_TRUE(std::isfinite(next)) << chance;
    EXPECT_GE(next, normal) << chance;
    normal = next;
    for (int degrees = 1; degrees <= 4; ++degrees) {
      double& before = chi_squared[static_cast<std::size_t>(degrees - 1)];
      const double of_these = ChiSquaredQuantile(1.0 - chance, degrees);
      EXPECT_TRUE(std::isfinite(of_these)) << chance << ' ' << degrees;
      EXPECT_GE(of_these, before) << chance << ' ' << degrees;
      before = of_these;
    }
  }
  EXPECT_TRUE(std::isfinite(NormalQuantile(0.0)));
}

TEST(Statistics, ChiSquaredQuantileIsGoodToTwoPerCent) {
  struct Entry {
    double probability;
    int degrees;
    double quantile;
  };
  constexpr std::array<Entry, 10> kTable = {{{0.95, 1, 3.8415},
                                             {0.95, 2, 5.9915},
                                             {0.95, 3, 7.8147},
                                             {0.95, 30, 43.773},
                                             {0.99, 1, 6.6349},
                                             {0.99, 3, 11.345},
                                             {0.999, 1, 10.828},
                                             {0.999, 3, 16.266},
                                             {0.999, 27, 55.476},
                                             {0.999, 100, 149.449}}};
  for (const Entry& entry : kTable) {
    EXPECT_NEAR(ChiSquaredQuantile(entry.probability, entry.degrees), entry.quantile,
                (entry.degrees <= 2 ? 1e-4 : 0.02) * entry.quantile)
        << entry.probability << ' ' << entry.degrees;
  }
}

}  // namespace
}  // namespace palpate
