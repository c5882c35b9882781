// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <random>

#include "libs/fem/bounded_qp.hpp"
#include "tests/support/heap_counter.hpp"

namespace palpate::fem {
namespace {

/// Bounds from -1 to 1, and a Gram matrix of this rank.
BoundedQp MakeQp(int n, int rank, std::mt19937* engine) {
  const auto random = [&] { return 4.0 * static_cast<double>((*engine)()) * 0x1p-32 - 2.0; };
  Eigen::MatrixXd root(n, rank);
  for (double& entry : root.reshaped()) entry = random();
  BoundedQp qp{root * root.transpose(), QpVector(n), -QpVector::Ones(n), QpVector::Ones(n)};
  for (double& entry : qp.c) entry = random();
  return qp;
}

TEST(BoundedQpAllocation, NothingIsAllocatedWhetherHIsRegularOrSingular) {
  if (!test_support::HeapRequestsAreCounted()) GTEST_SKIP() << "a sanitizer has its own malloc";
  std::mt19937 engine(21);
  for (int n = 1; n <= kMaxQpVariables; ++n) {
    for (const int rank : {n, (n + 1) / 2}) {
      const BoundedQp qp = MakeQp(n, rank, &engine);
      const QpVector start = QpVector::Zero(n);
      const size_t before = test_support::HeapRequestCount();
      const BoundedQpResult result = SolveBoundedQp(qp, start);
      EXPECT_EQ(test_support::HeapRequestCount(), before) << n << " variables, rank " << rank;
      EXPECT_TRUE(result.status.ok());
    }
  }
}

TEST(BoundedQpAllocation, TheCounterCounts) {
  if (!test_support::HeapRequestsAreCounted()) GTEST_SKIP() << "a sanitizer has its own malloc";
  const size_t before = test_support::HeapRequestCount();
  const Eigen::VectorXd on_the_heap = Eigen::VectorXd::Ones(7);
  EXPECT_GT(test_support::HeapRequestCount(), before) << on_the_heap.sum();
}

}  // namespace
}  // namespace palpate::fem
