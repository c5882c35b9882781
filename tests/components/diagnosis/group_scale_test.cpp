// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/inference/group_scale.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "libs/core/index.hpp"

namespace palpate::diagnosis {
namespace {

/// Three parameters with tolerances, and two groups of forty.
class GroupScale : public testing::Test {
 protected:
  static constexpr Eigen::Index kOthers = 3, kEach = 40, kAll = kOthers + 2 * kEach;
  static constexpr Eigen::Index kRows = 600;

  GroupScale() : prior_(kAll), J_(Normal(kRows, kAll)) {
    prior_.sigma.setOnes();
    for (Eigen::Index p = 0; p < kAll; ++p)
      group_of_.push_back(p < kOthers ? -1 : p < kOthers + kEach ? 0 : 1);
    J_.rightCols(2 * kEach) *= 20.0;
  }

  Eigen::MatrixXd Normal(Eigen::Index rows, Eigen::Index cols) {
    std::normal_distribution<double> normal;
    return Eigen::MatrixXd::NullaryExpr(rows, cols, [&] { return normal(random_); });
  }
  /// Measurements of groups with these deviations.
  Information Data(double first, double second) {
    Eigen::VectorXd z = Normal(kAll, 1);
    z.segment(kOthers, kEach) *= first;
    z.tail(kEach) *= second;
    const Eigen::VectorXd y = J_ * z + Normal(kRows, 1);
    Information data(kAll);
    data.H = J_.transpose() * J_;
    data.b = J_.transpose() * y;
    data.c = y.squaredNorm();
    return data;
  }
  double LnEvidence(const Information& data, const Eigen::VectorXd& scale) const {
    GaussianPrior prior = prior_;
    prior.sigma.segment(kOthers, kEach) *= scale[0];
    prior.sigma.tail(kEach) *= scale[1];
    return Infer(data, prior).ln_evidence;
  }

  std::mt19937 random_{3};
  GaussianPrior prior_;
  Eigen::MatrixXd J_;
  std::vector<int> group_of_;
};

TEST_F(GroupScale, FindsTheDeviationsThatTheDataHave) {
  const Eigen::VectorXd scale = InferGroupScale(Data(0.02, 0.005), prior_, group_of_, 2);
  EXPECT_NEAR(std::log(scale[0] / 0.02), 0.0, 0.35);
  EXPECT_NEAR(std::log(scale[1] / 0.005), 0.0, 0.35);
}

/// All else integrated out, it is the maximum of the evidence that all parameters together have.
TEST_F(GroupScale, IsTheMaximumOfTheEvidence) {
  const Information data = Data(0.01, 0.02);
  const Eigen::VectorXd scale = InferGroupScale(data, prior_, group_of_, 2);
  const double found = LnEvidence(data, scale);
  for (const double first : {0.7, 1.0, 1.4}) {
    for (const double second : {0.7, 1.0, 1.4}) {
      const Eigen::Vector2d beside(first * scale[0], second * scale[1]);
      EXPECT_LT(LnEvidence(data, beside), found + 0.1) << first << " " << second;
    }
  }
}

TEST_F(GroupScale, StaysWithinItsPrior) {
  const GroupScaleTuning tuning;
  EXPECT_NEAR(InferGroupScale(Data(0.0, 0.01), prior_, group_of_, 2)[0], tuning.least,
              3.0 * tuning.least);
  EXPECT_DOUBLE_EQ(InferGroupScale(Data(0.5, 0.01), prior_, group_of_, 2)[0], tuning.most);
}

TEST_F(GroupScale, StartsWhereItIsToldAndEndsAtTheSame) {
  const Information data = Data(0.01, 0.004);
  const Eigen::VectorXd one = InferGroupScale(data, prior_, group_of_, 2);
  const Eigen::VectorXd other =
      InferGroupScale(data, prior_, group_of_, 2, Eigen::Vector2d(0.002, 0.03));
  EXPECT_NEAR(LnEvidence(data, one), LnEvidence(data, other), 0.2);
}

}  // namespace
}  // namespace palpate::diagnosis
