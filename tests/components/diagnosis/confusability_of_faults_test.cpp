// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/inference/confusability_of_faults.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "libs/linalg/cholesky.hpp"
#include "tests/components/diagnosis/toy_faults.hpp"

namespace palpate::diagnosis {
namespace {

constexpr unsigned kImitationSeed = 20261126;

/// Two that look much alike, and two of one id that look like none.
HypothesisSet BookOfImitations() {
  std::vector<FaultModelPtr> causes;
  const auto add = [&](const std::string& id, double tolerance) {
    causes.push_back(std::make_unique<ToyFault>(
        id, std::vector<FaultParameter>{{.name = "size", .tolerance = tolerance, .fault = 20.0}}));
  };
  add("creep", 0.1);
  add("drift", 0.3);
  add("gain", 0.2);
  add("gain", 0.0);
  return {std::move(causes), {}};
}

class Imitations : public ::testing::Test {
 protected:
  Imitations() : data_(hypotheses_, kImitationSeed) {
    data_.SetColumn(1, data_.J().col(0) + 0.3 * data_.J().col(1));
  }
  Fit FitTo(const Eigen::VectorXd& y, const std::vector<int>& faults) const {
    return data_.FitTo(hypotheses_, y, faults);
  }
  Eigen::VectorXd Effect(int cause, double size) const { return size * data_.J().col(cause); }
  Information All() const { return FitTo(Effect(0, 0.0), {}).model.All(); }

  HypothesisSet hypotheses_ = BookOfImitations();
  ToyData data_;
};

/// From covariances of the data, by one parameter each.
double Explained(const HypothesisSet& hypotheses, const Eigen::MatrixXd& J, int withheld,
                 int other) {
  Eigen::VectorXd sigma = hypotheses.PriorWith({}).sigma;
  sigma(withheld) = 0.0;
  sigma(other) = 0.0;
  const auto inverse = [&] {
    const Eigen::MatrixXd D = sigma.asDiagonal();
    const Eigen::MatrixXd covariance =
        Eigen::MatrixXd::Identity(J.rows(), J.rows()) + J * D * D * J.transpose();
    return linalg::InverseSymmetric(covariance);
  };
  const Eigen::VectorXd effect = J.col(withheld);
  const double before = effect.dot(inverse() * effect);
  sigma(other) = hypotheses.PriorWith({other}).sigma(other);
  return 1.0 - effect.dot(inverse() * effect) / before;
}

TEST_F(Imitations, AreWhatCovariancesOfTheDataSay) {
  const std::vector<double> most = ExplainedByOthers(hypotheses_, All(), 1);
  ASSERT_EQ(most.size(), 4U);
  EXPECT_NEAR(most[0], Explained(hypotheses_, data_.J(), 0, 1), 1e-9);
  EXPECT_NEAR(most[1], Explained(hypotheses_, data_.J(), 1, 0), 1e-9);
  EXPECT_GT(most[0], 0.8) << "seed " << kImitationSeed;
  for (const int gain : {2, 3}) {
    EXPECT_LT(most[static_cast<std::size_t>(gain)], 0.2) << "seed " << kImitationSeed;
    EXPECT_NEAR(most[static_cast<std::size_t>(gain)],
                std::max(Explained(hypotheses_, data_.J(), gain, 0),
                         Explained(hypotheses_, data_.J(), gain, 1)),
                1e-9);
  }
}

TEST_F(Imitations, MoreExplainMore) {
  data_.SetColumn(3, data_.J().col(0) + data_.J().col(2));
  const double by_one = ExplainedByOthers(hypotheses_, All(), 1)[3];
  const double by_two = ExplainedByOthers(hypotheses_, All(), 2)[3];
  EXPECT_LT(by_one, 0.7) << "seed " << kImitationSeed;
  EXPECT_GT(by_two, by_one);
  EXPECT_LT(by_two, 0.95) << "the gain of another cable is withheld with it";
}

TEST_F(Imitations, AreNotLookedForWhereNothingWouldBeSeen) {
  data_.SetColumn(2, 1e-3 * data_.J().col(2));
  EXPECT_EQ(ExplainedByOthers(hypotheses_, All(), 1)[2], -1.0);
}

TEST_F(Imitations, CountOnceForEachId) {
  EXPECT_DOUBLE_EQ(ShareOfConfusable(hypotheses_, All(), 1, 0.0), 1.0);
  EXPECT_DOUBLE_EQ(ShareOfConfusable(hypotheses_, All(), 1, 0.8), 2.0 / 3.0);
  EXPECT_DOUBLE_EQ(ShareOfConfusable(hypotheses_, All(), 1, 0.999), 0.0);
}

TEST_F(Imitations, WhatExplainsLittleMayWellStandForAnother) {
  const Eigen::VectorXd y =
      Effect(3, 5.0) + data_.Normal(data_.rows(), 1);  // the two others explain little of it
  const double chance = ProbabilityOfConfusion(hypotheses_, FitTo(y, {}), FitTo(y, {0}), false);
  EXPECT_DOUBLE_EQ(chance, 0.5) << "seed " << kImitationSeed;
}

TEST_F(Imitations, WhatExplainsAllButALittleStandsForItself) {
  const Eigen::VectorXd y = Effect(3, 50.0) + Effect(0, 1.0) + data_.Normal(data_.rows(), 1);
  EXPECT_LT(ProbabilityOfConfusion(hypotheses_, FitTo(y, {}), FitTo(y, {3}), false), 0.05)
      << "seed " << kImitationSeed;
}

TEST_F(Imitations, ThatLeaveNoiseAreRare) {
  const Eigen::VectorXd noise = data_.Normal(data_.rows(), 1);
  const auto chance = [&](double size) {
    const Eigen::VectorXd y = Effect(0, size) + noise;
    return ProbabilityOfConfusion(hypotheses_, FitTo(y, {}), FitTo(y, {0}), true);
  };
  EXPECT_DOUBLE_EQ(chance(3.0), (2.0 / 3.0) / (20.0 + 2.0 / 3.0))
      << "creep and drift of the three would pass for each other, seed " << kImitationSeed;
  EXPECT_LT(chance(50.0), 0.01) << "as large, the difference would be seen";
}

TEST_F(Imitations, AreTheLikelierTheMoreIsNamed) {
  const Eigen::VectorXd y = Effect(0, 3.0) + Effect(2, 1.0) + data_.Normal(data_.rows(), 1);
  const double one = ProbabilityOfConfusion(hypotheses_, FitTo(y, {}), FitTo(y, {0}), true);
  const double two = ProbabilityOfConfusion(hypotheses_, FitTo(y, {}), FitTo(y, {0, 2}), true);
  EXPECT_GT(one, 0.02) << "seed " << kImitationSeed;
  EXPECT_GE(two / (1.0 - two), 2.9 * one / (1.0 - one)) << "seed " << kImitationSeed;
}

}  // namespace
}  // namespace palpate::diagnosis
