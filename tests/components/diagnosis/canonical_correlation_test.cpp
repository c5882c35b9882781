// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/inference/canonical_correlation.hpp"

#include <gtest/gtest.h>

#include "libs/linalg/cholesky.hpp"
#include "libs/linalg/qr.hpp"
#include "libs/linalg/svd.hpp"
#include "tests/components/diagnosis/toy_faults.hpp"

namespace palpate::diagnosis {
namespace {

constexpr int kFault = 2;
constexpr int kSwap = 3;

class CanonicalCorrelationTest : public testing::Test {
 protected:
  double Of(int a, int b) const {
    const Fit fit = data_.FitTo(hypotheses_, Eigen::VectorXd::Zero(data_.rows()), {});
    return CanonicalCorrelation(hypotheses_, fit.model.All(), fit.posterior.scale, a, b);
  }

  /// From the effects themselves: cosine of the least angle between what the others leave of them.
  double FromEffects(int a, int b) const {
    const Eigen::VectorXd sigma = hypotheses_.PriorWith({}).sigma;
    const std::vector<Eigen::Index> own = hypotheses_.ParametersOf({a, b});
    std::vector<Eigen::Index> others;
    for (Eigen::Index p = 0; p < sigma.size(); ++p) {
      if (std::find(own.begin(), own.end(), p) == own.end()) others.push_back(p);
    }
    const Eigen::VectorXd weight = sigma(others);
    const Eigen::MatrixXd C = data_.J()(Eigen::all, others) * weight.asDiagonal();
    const Eigen::MatrixXd left =
        linalg::Cholesky(Eigen::MatrixXd::Identity(C.rows(), C.rows()) + C * C.transpose())
            .Inverse();
    const auto basis = [&](int k) {
      const Eigen::MatrixXd effect =
          data_.J().middleCols(hypotheses_.first(k), hypotheses_.count(k));
      return linalg::OrthonormalBasis(left * effect);
    };
    return linalg::SingularValues(basis(a).transpose() * basis(b))[0];
  }

  HypothesisSet hypotheses_ = ToyBook();
  ToyData data_{hypotheses_, 7};
};

TEST_F(CanonicalCorrelationTest, IsThatOfTheEffectsThemselves) {
  for (const auto& [a, b] : {std::pair(kFault, kSwap), std::pair(0, kSwap), std::pair(0, 1)}) {
    EXPECT_NEAR(Of(a, b), FromEffects(a, b), 1e-9) << a << ' ' << b;
    EXPECT_NEAR(Of(a, b), Of(b, a), 1e-9);
    EXPECT_LT(Of(a, b), 0.9);
  }
}

TEST_F(CanonicalCorrelationTest, OfTheSameEffectIsOneWhateverItsSize) {
  data_.SetColumn(hypotheses_.first(kSwap), 1e-3 * data_.J().col(hypotheses_.first(kFault)));
  EXPECT_NEAR(Of(kFault, kSwap), 1.0, 1e-6);
}

TEST_F(CanonicalCorrelationTest, IsZeroWithoutAnEffect) {
  data_.SetColumn(hypotheses_.first(kFault), Eigen::VectorXd::Zero(data_.rows()));
  EXPECT_EQ(Of(kFault, kSwap), 0.0);
}

}  // namespace
}  // namespace palpate::diagnosis
