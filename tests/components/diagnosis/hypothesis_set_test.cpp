// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/inference/hypothesis_set.hpp"

#include <gtest/gtest.h>

#include "tests/components/diagnosis/toy_faults.hpp"

namespace palpate::diagnosis {
namespace {

TEST(HypothesisSet, KnowsWhereParametersStand) {
  const HypothesisSet hypotheses = ToyBook();
  EXPECT_EQ(hypotheses.size(), 4);
  EXPECT_EQ(hypotheses.parameter_count(), 5);
  EXPECT_EQ(hypotheses.first(3), 3);
  EXPECT_EQ(hypotheses.count(3), 2);
  EXPECT_EQ(hypotheses.ParametersOf({3, 0}), (std::vector<Eigen::Index>{3, 4, 0}));
}

TEST(HypothesisSet, AHealthyRobotIsWithinItsTolerancesAndAFaultBeyond) {
  const HypothesisSet hypotheses = ToyBook();
  const GaussianPrior null_model = hypotheses.PriorWith({});
  EXPECT_TRUE(null_model.mean.isZero(0.0));
  EXPECT_EQ(null_model.sigma, (Eigen::VectorXd(5) << 0.5, 0.4, 0.0, 0.0, 0.1).finished());
  const GaussianPrior faulty = hypotheses.PriorWith({0, 3});
  EXPECT_EQ(faulty.sigma, (Eigen::VectorXd(5) << 20.0, 0.4, 0.0, 5.0, 5.0).finished());
  EXPECT_EQ(faulty.mean, (Eigen::VectorXd(5) << 0.0, 0.0, 0.0, 3.0, 0.0).finished());
  EXPECT_FALSE(hypotheses.CanBeFault(1));
  EXPECT_TRUE(hypotheses.CanBeFault(2));
}

TEST(HypothesisSet, TakesTolerancesOfTheExperiment) {
  std::vector<FaultModelPtr> causes;
  causes.push_back(std::make_unique<ToyFault>(
      "two", std::vector<FaultParameter>{{.name = "a", .tolerance = 0.2, .fault = 1.0},
                                         {.name = "b", .tolerance = 0.4, .fault = 1.0}}));
  causes.push_back(std::make_unique<ToyFault>(
      "none",
      std::vector<FaultParameter>{{.name = "c", .fault = 1.0}, {.name = "d", .fault = 1.0}}));
  const HypothesisSet hypotheses(std::move(causes),
                                 {{"two", 0.6}, {"none", 0.3}, {"unknown", 9.0}});
  EXPECT_NEAR(hypotheses.ToleranceOf(0, 0), 0.6, 1e-15);
  EXPECT_NEAR(hypotheses.ToleranceOf(0, 1), 1.2, 1e-15) << "in proportion";
  EXPECT_NEAR(hypotheses.ToleranceOf(1, 0), 0.3, 1e-15);
  EXPECT_EQ(hypotheses.ToleranceOf(1, 1), 0.0);
  EXPECT_NEAR(hypotheses.PriorWith({}).sigma[1], 1.2, 1e-15);
  EXPECT_NEAR(hypotheses.PriorWith({0}).sigma[1], 1.2, 1e-15)
      << "a fault is no tighter than healthy";
}

TEST(HypothesisSet, TakesTheToleranceOfAVectorAsThatOfItsLength) {
  const FaultParameter along{.name = "d", .tolerance = 0.1, .fault = 1.0, .component = true};
  std::vector<FaultModelPtr> causes;
  causes.push_back(std::make_unique<ToyFault>(
      "vector", std::vector<FaultParameter>{along, along, along, along}));
  const HypothesisSet hypotheses(std::move(causes), {{"vector", 0.6}});
  for (int p = 0; p < 4; ++p) EXPECT_NEAR(hypotheses.ToleranceOf(0, p), 0.3, 1e-15);
}

/// Data that say z of each parameter to within 0.1.
Information Says(const Eigen::VectorXd& z) {
  Information data(z.size());
  data.H.diagonal().setConstant(100.0);
  data.b = 100.0 * z;
  data.c = 100.0 * z.squaredNorm();
  return data;
}

TEST(HypothesisSet, WhatWouldGoBeyondItsBoundsEndsThere) {
  const HypothesisSet hypotheses = ToyBook();
  const auto infer = [&](double c) {
    return hypotheses.InferWithin(Says((Eigen::VectorXd(5) << 0.0, 0.0, c, 0.0, 0.0).finished()),
                                  {2});
  };
  EXPECT_NEAR(infer(10.0).mean[2], 10.0, 1e-3);
  EXPECT_GT(infer(10.0).covariance(2, 2), 0.0);
  EXPECT_EQ(infer(-10.0).mean[2], 0.0);
  EXPECT_EQ(infer(50.0).mean[2], 40.0);
  EXPECT_EQ(infer(50.0).covariance(2, 2), 0.0);
  // At the bound it explains no more than it would there.
  EXPECT_NEAR(infer(-10.0).ln_evidence,
              -0.5 * 100.0 * 100.0 - std::log(std::sqrt(26.0)) - std::log(std::sqrt(17.0)) -
                  std::log(std::sqrt(2.0)),
              1e-6);
}

/// One size times exp of another parameter, which says how it acts, on six samples: seen from where
/// both are far from zero.
struct Product {
  HypothesisSet hypotheses = [] {
    std::vector<FaultModelPtr> causes;
    causes.push_back(std::make_unique<ToyFault>(
        "placed", std::vector<FaultParameter>{{.name = "size", .fault = 9.0},
                                              {.name = "where", .fault = 9.0, .qualifies = true}}));
    causes.push_back(std::make_unique<ToyFault>(
        "plain", std::vector<FaultParameter>{{.name = "plain", .fault = 1.0}}));
    return HypothesisSet(std::move(causes), {});
  }();
  Eigen::VectorXd y = (Eigen::VectorXd(6) << 5.0, -3.0, 8.0, 1.0, -2.0, 4.0).finished();

  Information SeenFrom(double size, double where) const {
    const Eigen::VectorXd rate = Eigen::VectorXd::LinSpaced(6, -0.4, 0.6);
    const Eigen::VectorXd effect = (where * rate).array().exp();
    Eigen::MatrixXd J = Eigen::MatrixXd::Zero(6, 3);
    J.col(0) = effect;
    J.col(1) = size * rate.cwiseProduct(effect);
    const Eigen::Vector3d z(size, where, 0.0);
    const Eigen::VectorXd off = y - size * effect + J * z;
    Information data(3);
    data.H = J.transpose() * J;
    data.b = J.transpose() * off;
    data.c = off.squaredNorm();
    data.about = z;
    return data;
  }
};

TEST(HypothesisSet, NothingIsLeftOfACauseThatIsTakenAwayWhereItWasFarFromNone) {
  const Product product;
  const Posterior without = product.hypotheses.InferWithin(product.SeenFrom(4.0, 1.5), {1});
  EXPECT_EQ(without.mean[0], 0.0);
  EXPECT_NEAR(without.misfit, product.y.squaredNorm(), 1e-9);
  EXPECT_EQ(product.hypotheses.Idle({1}), std::vector<Eigen::Index>{1});
  EXPECT_TRUE(product.hypotheses.Idle({0}).empty());
}

}  // namespace
}  // namespace palpate::diagnosis
