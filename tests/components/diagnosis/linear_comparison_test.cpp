// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/inference/linear_comparison.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "components/diagnosis/inference/simulated_healthy.hpp"
#include "tests/components/diagnosis/toy_faults.hpp"

namespace palpate::diagnosis {
namespace {

constexpr double kClear = 10.0;
constexpr double kLeastTolerances = 3.0;

class LinearComparisonOfToys : public testing::Test {
 protected:
  Fit Measured(const Eigen::VectorXd& z) {
    const Eigen::VectorXd y = data_.J() * z + Eigen::VectorXd(data_.Normal(data_.rows(), 1));
    return data_.FitTo(hypotheses_, y, {});
  }
  LinearComparison Of(const Fit& fit) const {
    return {hypotheses_, fit.model.All().H, hypotheses_.PriorWith({}, fit.posterior.scale)};
  }
  double Slowly(const Information& data, int fault) const {
    return hypotheses_.InferWithin(data, {fault}).ln_evidence -
           hypotheses_.InferWithin(data, {}).ln_evidence;
  }

  HypothesisSet hypotheses_ = ToyBook();
  ToyData data_{hypotheses_, 5};
};

TEST_F(LinearComparisonOfToys, SaysWhatEvidencesSay) {
  const Fit fit = Measured((Eigen::VectorXd(5) << 0.3, 0.1, 2.0, 0.2, 0.3).finished());
  const Information data = fit.model.All();
  const Eigen::VectorXd all = Of(fit).LnBayesFactors(data.b);
  for (int k = 0; k < hypotheses_.size(); ++k) {
    if (!hypotheses_.CanBeFault(k)) {
      EXPECT_EQ(all[k], -std::numeric_limits<double>::infinity());
      continue;
    }
    EXPECT_NEAR(all[k], Slowly(data, k), 1e-6 * (1.0 + std::abs(all[k]))) << k;
  }
}

TEST_F(LinearComparisonOfToys, FindsTheSizeFromWhichAFaultIsNamed) {
  const Fit fit = Measured(Eigen::VectorXd::Zero(5));
  const Information data = fit.model.All();
  const auto sizes = FindSmallestSizes(hypotheses_, Of(fit), data.H, kClear, kLeastTolerances);
  ASSERT_EQ(sizes.size(), 3U);
  for (const SmallestSize& one : sizes) {
    ASSERT_TRUE(std::isfinite(one.z)) << one.fault;
    const Eigen::Index column = hypotheses_.first(one.fault) + one.parameter;
    const auto exactly = [&](double z) {
      Information of_size = data;
      of_size.b = z * data.H.col(column);
      of_size.c = z * z * data.H(column, column);
      return Slowly(of_size, one.fault);
    };
    EXPECT_GE(exactly(1.01 * one.z), kClear);
    const double tolerance = hypotheses_.ToleranceOf(one.fault, one.parameter);
    EXPECT_TRUE(exactly(0.99 * one.z) < kClear || one.z <= 1.001 * kLeastTolerances * tolerance);
  }
}

TEST_F(LinearComparisonOfToys, AcquitsRobotsOfTheNullModel) {
  const Fit fit = Measured(Eigen::VectorXd::Zero(5));
  const SimulatedHealthy healthy =
      SimulateHealthyRobots(hypotheses_, Of(fit), fit, kClear, kLeastTolerances);
  EXPECT_EQ(healthy.drawn, 200);
  EXPECT_LE(healthy.accused, 4);
  EXPECT_LT(healthy.ln_bayes_factor_98, kClear);
  // With a bar that is no bar most would be accused.
  EXPECT_GT(SimulateHealthyRobots(hypotheses_, Of(fit), fit, -1e3, 0.0).accused, 150);
}

}  // namespace
}  // namespace palpate::diagnosis
