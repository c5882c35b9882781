// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/inference/cause_book.hpp"

#include <gtest/gtest.h>

#include "tests/components/diagnosis_core/toy_causes.hpp"

namespace palpate::diagnosis {
namespace {

TEST(CauseBook, KnowsWhereParametersStand) {
  const CauseBook book = ToyBook();
  EXPECT_EQ(book.size(), 4);
  EXPECT_EQ(book.parameter_count(), 5);
  EXPECT_EQ(book.first(3), 3);
  EXPECT_EQ(book.count(3), 2);
  EXPECT_EQ(book.ParametersOf({3, 0}), (std::vector<Eigen::Index>{3, 4, 0}));
}

TEST(CauseBook, AHealthyRobotIsWithinItsTolerancesAndAFaultBeyond) {
  const CauseBook book = ToyBook();
  const Belief healthy = book.BeliefWith({});
  EXPECT_TRUE(healthy.mean.isZero(0.0));
  EXPECT_EQ(healthy.sigma, (Eigen::VectorXd(5) << 0.5, 0.4, 0.0, 0.0, 0.1).finished());
  const Belief faulty = book.BeliefWith({0, 3});
  EXPECT_EQ(faulty.sigma, (Eigen::VectorXd(5) << 20.0, 0.4, 0.0, 5.0, 5.0).finished());
  EXPECT_EQ(faulty.mean, (Eigen::VectorXd(5) << 0.0, 0.0, 0.0, 3.0, 0.0).finished());
  EXPECT_FALSE(book.CanBeFault(1));
  EXPECT_TRUE(book.CanBeFault(2));
}

TEST(CauseBook, TakesTolerancesOfTheExperiment) {
  std::vector<CausePtr> causes;
  causes.push_back(std::make_unique<ToyCause>(
      "two", std::vector<CauseParameter>{{.name = "a", .tolerance = 0.2, .fault = 1.0},
                                         {.name = "b", .tolerance = 0.4, .fault = 1.0}}));
  causes.push_back(std::make_unique<ToyCause>(
      "none",
      std::vector<CauseParameter>{{.name = "c", .fault = 1.0}, {.name = "d", .fault = 1.0}}));
  const CauseBook book(std::move(causes), {{"two", 0.6}, {"none", 0.3}, {"unknown", 9.0}});
  EXPECT_NEAR(book.ToleranceOf(0, 0), 0.6, 1e-15);
  EXPECT_NEAR(book.ToleranceOf(0, 1), 1.2, 1e-15) << "in proportion";
  EXPECT_NEAR(book.ToleranceOf(1, 0), 0.3, 1e-15);
  EXPECT_EQ(book.ToleranceOf(1, 1), 0.0);
  EXPECT_NEAR(book.BeliefWith({}).sigma[1], 1.2, 1e-15);
  EXPECT_NEAR(book.BeliefWith({0}).sigma[1], 1.2, 1e-15) << "a fault is no tighter than healthy";
}

/// Data that say z of each parameter to within 0.1.
Information Says(const Eigen::VectorXd& z) {
  Information data(z.size());
  data.H.diagonal().setConstant(100.0);
  data.b = 100.0 * z;
  data.c = 100.0 * z.squaredNorm();
  return data;
}

TEST(CauseBook, WhatWouldGoBeyondItsBoundsEndsThere) {
  const CauseBook book = ToyBook();
  const auto infer = [&](double c) {
    return book.InferWithin(Says((Eigen::VectorXd(5) << 0.0, 0.0, c, 0.0, 0.0).finished()), {2});
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

}  // namespace
}  // namespace palpate::diagnosis
