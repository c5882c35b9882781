// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/inference/cross_validation.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "components/diagnosis/inference/forward_selection.hpp"
#include "libs/linalg/cholesky.hpp"
#include "tests/components/diagnosis/toy_faults.hpp"

namespace palpate::diagnosis {
namespace {

constexpr unsigned kHeldOutSeed = 11;

CrossValidation LeftOut(const HypothesisSet& hypotheses, const ToyData& data,
                        const Eigen::VectorXd& y, const std::vector<int>& faults) {
  return LeaveOneOut(hypotheses, data.FitTo(hypotheses, y, faults).model, faults);
}

TEST(LeaveOneOut, PredictsEachRecordingFromTheOthersAlone) {
  const HypothesisSet hypotheses = ToyBook();
  ToyData data(hypotheses, kHeldOutSeed);
  const std::vector<int> faults{0};
  const GaussianPrior prior = hypotheses.PriorWith(faults);
  const Eigen::VectorXd y = data.Draw(prior);
  const CrossValidation out = LeftOut(hypotheses, data, y, faults);
  const Eigen::MatrixXd S = prior.sigma.array().square().matrix().asDiagonal();
  const Eigen::MatrixXd all =
      data.J() * S * data.J().transpose() + Eigen::MatrixXd::Identity(data.rows(), data.rows());
  std::vector<Eigen::Index> order(static_cast<std::size_t>(data.rows()));
  for (Eigen::Index r = 0; r < 3; ++r) {
    std::vector<Eigen::Index> own;
    std::vector<Eigen::Index> others;
    for (Eigen::Index row = 0; row < data.rows(); ++row) {
      (row / 36 == r ? own : others).push_back(row);
    }
    // Conditional normal distribution of the dense covariance.
    const Eigen::MatrixXd gain = all(own, others) * linalg::InverseSymmetric(all(others, others));
    const Eigen::VectorXd off = y(own) - gain * y(others);
    const linalg::Cholesky factor(all(own, own) - gain * all(others, own));
    const double ln_p = -0.5 * off.dot(factor.Solve(off)) - 0.5 * factor.LnDeterminant();
    const auto k = static_cast<std::size_t>(r);
    EXPECT_NEAR(out.chi_squared[k], off.squaredNorm(), 1e-8 * off.squaredNorm());
    EXPECT_NEAR(out.ln_predicted[k], ln_p, 1e-8 * std::abs(ln_p));
    EXPECT_TRUE(out.residual.segment(36 * r, 36).isApprox(off, 1e-8));
  }
}

TEST(FittedShare, IsLargeForARightFaultAndNextToNothingForAWrongOne) {
  const HypothesisSet hypotheses = ToyBook();
  ToyData data(hypotheses, kHeldOutSeed);
  const Eigen::VectorXd healthy = data.Draw(hypotheses.PriorWith({}));
  const Eigen::VectorXd faulty = healthy + 6.0 * data.J().col(hypotheses.first(2));
  const auto share = [&](const Eigen::VectorXd& y, int fault) {
    return FittedShare(data.FitTo(hypotheses, y, {}), data.FitTo(hypotheses, y, {fault}));
  };
  EXPECT_GT(share(faulty, 2), 0.9);
  EXPECT_LT(share(healthy, 3), kSelectionTuning.least_explained) << "seed " << kHeldOutSeed;
}

TEST(LeaveOneOut, ARightFaultPredictsBetterAndAWrongOneDoesNot) {
  const HypothesisSet hypotheses = ToyBook();
  ToyData data(hypotheses, kHeldOutSeed);
  const Eigen::VectorXd y =
      data.Draw(hypotheses.PriorWith({})) + 6.0 * data.J().col(hypotheses.first(2));
  const CrossValidation without = LeftOut(hypotheses, data, y, {});
  const CrossValidationGain right = Compare(without, LeftOut(hypotheses, data, y, {2}));
  EXPECT_TRUE(right.clear);
  EXPECT_GT(right.relative, 0.9);
  const CrossValidationGain none = Compare(without, without);
  EXPECT_FALSE(none.clear);
  EXPECT_EQ(none.ln_gain, 0.0);
  const Eigen::VectorXd null_model = data.Draw(hypotheses.PriorWith({}));
  const CrossValidationGain wrong = Compare(LeftOut(hypotheses, data, null_model, {}),
                                            LeftOut(hypotheses, data, null_model, {3}));
  EXPECT_LT(wrong.ln_gain, 0.0) << "seed " << kHeldOutSeed;
  EXPECT_FALSE(wrong.clear);
}

}  // namespace
}  // namespace palpate::diagnosis
