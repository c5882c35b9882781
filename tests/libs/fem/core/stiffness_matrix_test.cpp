// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/stiffness_matrix.hpp"

#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <numeric>
#include <thread>
#include <vector>

#include "libs/fem/sparse/recent_orders.hpp"
#include "libs/linalg/cholesky.hpp"
#include "tests/libs/fem/core/laws.hpp"

namespace palpate::fem {
namespace {

using Fixed = Eigen::Matrix<bool, 3, Eigen::Dynamic>;

/// Nodes of a k x k x k grid, each coupled with its neighbours.
NodePairs GridPairs(int k) {
  NodePairs pairs;
  for (int n = 0; n < k * k * k; ++n) {
    if (n % k + 1 < k) pairs.emplace_back(n, n + 1);
    if (n / k % k + 1 < k) pairs.emplace_back(n + k, n);
    if (n + k * k < k * k * k) pairs.emplace_back(n, n + k * k);
  }
  return pairs;
}

Eigen::MatrixXd Dense(const StiffnessMatrix& K) {
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(K.Size(), K.Size());
  const BlockPattern pattern = K.Pattern();
  for (int j = 0; j < pattern.NodeCount(); ++j) {
    for (int k = pattern.column_start[j]; k < pattern.column_start[j + 1]; ++k) {
      const int i = pattern.row[static_cast<size_t>(k)];
      const Eigen::Map<const Eigen::Matrix3d> block(K.Values().data() + kBlockEntries * k);
      dense.block<3, 3>(3 * j, 3 * i) = block.transpose();
      dense.block<3, 3>(3 * i, 3 * j) = block;
    }
  }
  return dense;
}

/// A symmetric matrix over all nodes with random blocks on the diagonal and the declared pairs, and
/// the same added to `K` with every pair once as (a, b) and once as (b, a).
Eigen::MatrixXd FillAtRandom(const NodePairs& pairs, int nodes, StiffnessMatrix* K) {
  std::mt19937 engine(2);
  Eigen::MatrixXd full = Eigen::MatrixXd::Zero(3 * nodes, 3 * nodes);
  const auto random_block = [&] {
    return Eigen::Matrix3d(laws::RandomVector(9, 1.0, &engine).reshaped(3, 3));
  };
  for (const auto& [a, b] : pairs) {
    const Eigen::Matrix3d first = random_block();
    const Eigen::Matrix3d second = random_block();
    K->Add(K->Slot(a, b), first);
    K->Add(K->Slot(b, a), Eigen::Matrix3d(second.transpose()));
    full.block<3, 3>(3 * a, 3 * b) += first + second;
    full.block<3, 3>(3 * b, 3 * a) += (first + second).transpose();
  }
  for (int n = 0; n < nodes; ++n) {
    const Eigen::Matrix3d half = random_block();
    const Eigen::Matrix3d block = half * half.transpose() + 8.0 * Eigen::Matrix3d::Identity();
    K->Add(K->Slot(n, n), block);
    full.block<3, 3>(3 * n, 3 * n) += block;
  }
  return full;
}

/// Row of `K` for each direction of each node, or -1.
std::vector<int> Rows(const StiffnessMatrix& K) {
  std::vector<int> rows;
  for (int n = 0; n < K.NodeCount(); ++n) {
    for (int i = 0; i < 3; ++i) {
      rows.push_back(K.FreeIndex(n) < 0 ? -1 : 3 * K.FreeIndex(n) + i);
    }
  }
  return rows;
}

TEST(StiffnessMatrix, EqualsTheDenseAssemblyOverTheFreeNodes) {
  const NodePairs pairs = GridPairs(3);
  Fixed fixed = Fixed::Constant(3, 27, false);
  for (const int node : {0, 5, 13}) fixed.col(node).setConstant(true);
  StiffnessMatrix K(fixed, pairs);
  const Eigen::MatrixXd full = FillAtRandom(pairs, 27, &K);
  ASSERT_EQ(K.Size(), 72);
  const Eigen::MatrixXd dense = Dense(K);
  const std::vector<int> rows = Rows(K);
  for (Eigen::Index i = 0; i < full.rows(); ++i) {
    for (Eigen::Index j = 0; j < full.cols(); ++j) {
      const int r = rows[static_cast<size_t>(i)];
      const int c = rows[static_cast<size_t>(j)];
      if (r >= 0 && c >= 0) {
        EXPECT_NEAR(dense(r, c), full(i, j), 1e-14);
      }
    }
  }
  std::mt19937 engine(4);
  const Eigen::VectorXd v = laws::RandomVector(K.Size(), 1.0, &engine);
  EXPECT_LE((K.Times(v) - dense * v).norm(), 1e-13 * v.norm() * dense.norm());
  EXPECT_NEAR(K.MeanDiagonal(), dense.diagonal().mean(), 1e-13);
  K.AddRelativeShift(0.5);
  EXPECT_LE(
      (Dense(K) - dense - 0.5 * dense.diagonal().mean() * Eigen::MatrixXd::Identity(72, 72)).norm(),
      1e-12);
  const double before = Dense(K)(0, 0);
  K.SetZero(1, 24);
  EXPECT_EQ(Dense(K).bottomRightCorner(69, 69).norm(), 0.0);
  EXPECT_EQ(Dense(K)(0, 0), before);
  K.SetZero(0, 1);
  EXPECT_EQ(Dense(K).norm(), 0.0);
}

TEST(StiffnessMatrix, RowsAreAscendingAndStartWithTheDiagonal) {
  const StiffnessMatrix K(Fixed::Constant(3, 27, false), GridPairs(3));
  const BlockPattern pattern = K.Pattern();
  for (size_t j = 0; j + 1 < pattern.column_start.size(); ++j) {
    const auto first = pattern.row.begin() + pattern.column_start[j];
    const auto last = pattern.row.begin() + pattern.column_start[j + 1];
    ASSERT_LT(first, last);
    EXPECT_EQ(*first, static_cast<int>(j));
    EXPECT_TRUE(std::adjacent_find(first, last, std::greater_equal<>()) == last);
  }
}

TEST(StiffnessMatrix, SingleFixedDirectionsStayWhereTheyAre) {
  const NodePairs pairs = GridPairs(2);
  Fixed fixed = Fixed::Constant(3, 8, false);
  fixed(1, 6) = fixed(0, 2) = fixed(2, 2) = true;
  fixed.col(4).setConstant(true);
  StiffnessMatrix K(fixed, pairs);
  const Eigen::MatrixXd full = FillAtRandom(pairs, 8, &K);
  K.FixSingleDirections();
  std::mt19937 engine(6);
  const Eigen::VectorXd force = laws::RandomVector(24, 1.0, &engine);
  Eigen::VectorXd reduced(K.Size());
  K.Reduce(force, reduced);
  const Eigen::VectorXd solved = linalg::SolveSymmetric(Dense(K), reduced);
  Eigen::VectorXd u = Eigen::VectorXd::Zero(24);
  K.AddExpanded(solved, 1.0, u);

  std::vector<Eigen::Index> free_rows;
  for (Eigen::Index i = 0; i < 24; ++i) {
    if (!fixed.reshaped()[i])
      free_rows.push_back(i);
    else
      EXPECT_EQ(u[i], 0.0);
  }
  const Eigen::VectorXd expected =
      linalg::SolveSymmetric(full(free_rows, free_rows), Eigen::VectorXd(force(free_rows)));
  EXPECT_LE((u(free_rows) - expected).norm(), 1e-12 * expected.norm());
}

TEST(StiffnessMatrix, ReducesAndExpands) {
  Fixed fixed = Fixed::Constant(3, 8, false);
  fixed.col(3).setConstant(true);
  fixed(0, 5) = true;
  const StiffnessMatrix K(fixed, GridPairs(2));
  const Eigen::VectorXd nodal = Eigen::VectorXd::LinSpaced(24, 1.0, 24.0);
  Eigen::VectorXd reduced(K.Size());
  K.Reduce(nodal, reduced);
  Eigen::VectorXd back = Eigen::VectorXd::Ones(24);
  K.AddExpanded(reduced, 2.0, back);
  for (int i = 0; i < 24; ++i) {
    EXPECT_EQ(back[i], fixed.reshaped()[i] ? 1.0 : 1.0 + 2.0 * nodal[i]);
  }
}

TEST(StiffnessMatrixDeathTest, ChecksThatAPairWasDeclared) {
  const StiffnessMatrix K(Fixed::Constant(3, 8, false), GridPairs(2));
  EXPECT_DEATH(static_cast<void>(K.Slot(0, 7)), "found");
}

/// Nonzeros of the Cholesky factor of a graph eliminated in this order.
int FactorEntries(int nodes, const NodePairs& pairs, const std::vector<int>& order) {
  std::vector<int> place(order.size());
  for (size_t k = 0; k < order.size(); ++k) {
    place[static_cast<size_t>(order[k])] = static_cast<int>(k);
  }
  Eigen::Matrix<bool, Eigen::Dynamic, Eigen::Dynamic> filled =
      Eigen::Matrix<bool, Eigen::Dynamic, Eigen::Dynamic>::Identity(nodes, nodes);
  for (const auto& [a, b] : pairs) {
    const int i = place[static_cast<size_t>(a)];
    const int j = place[static_cast<size_t>(b)];
    filled(std::max(i, j), std::min(i, j)) = true;
  }
  for (int k = 0; k < nodes; ++k) {
    for (int i = k + 1; i < nodes; ++i) {
      if (!filled(i, k)) continue;
      for (int j = k + 1; j <= i; ++j) filled(i, j) = filled(i, j) || filled(j, k);
    }
  }
  return static_cast<int>(filled.count());
}

TEST(EliminationOrder, IsAPermutationWithLessFillThanTheNaturalOrder) {
  const NodePairs pairs = GridPairs(7);
  std::vector<int> natural(343);
  std::iota(natural.begin(), natural.end(), 0);
  const std::vector<int> order = FindEliminationOrder(343, pairs).nodes;
  EXPECT_TRUE(std::is_permutation(order.begin(), order.end(), natural.begin(), natural.end()));
  EXPECT_LT(FactorEntries(343, pairs, order), 0.7 * FactorEntries(343, pairs, natural));
}

/// The same order as one by one, and the process still ends at SIGTERM.
TEST(EliminationOrder, IsFoundOnSeveralThreadsAtOnce) {
  const NodePairs pairs = GridPairs(9);
  const std::vector<int> alone = FindEliminationOrder(729, pairs).nodes;
  std::vector<int> differ(4, 0);
  std::vector<std::thread> threads;
  for (int& others : differ) {
    threads.emplace_back([&pairs, &alone, &others] {
      for (int k = 0; k < 10; ++k) others += FindEliminationOrder(729, pairs).nodes != alone;
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(differ, std::vector<int>(4, 0));
  struct sigaction on_terminate {};
  ASSERT_EQ(sigaction(SIGTERM, nullptr, &on_terminate), 0);
  EXPECT_EQ(on_terminate.sa_handler, SIG_DFL);
}

TEST(EliminationOrder, TakesRepeatedPairsAndLonelyNodes) {
  std::vector<int> order = FindEliminationOrder(4, {{0, 2}, {2, 0}, {0, 2}}).nodes;
  std::sort(order.begin(), order.end());
  EXPECT_EQ(order, (std::vector<int>{0, 1, 2, 3}));
}

TEST(RecentOrders, AreThoseThatWouldBeFound) {
  RecentOrders recent;
  for (int round = 0; round < 2; ++round) {
    for (const int edge : {3, 4, 5}) {
      const NodePairs pairs = GridPairs(edge);
      const int nodes = edge * edge * edge;
      const EliminationOrder order = recent.Find(nodes, pairs);
      const EliminationOrder found = FindEliminationOrder(nodes, pairs);
      EXPECT_EQ(order.nodes, found.nodes);
      EXPECT_EQ(order.supernode_start, found.supernode_start);
    }
  }
  EXPECT_EQ(recent.found_count(), 3);
}

TEST(RecentOrders, AreOfTheirOwnPairsAndNodes) {
  RecentOrders recent;
  recent.Find(4, {{0, 1}});
  recent.Find(4, {{0, 2}});
  EXPECT_EQ(recent.Find(5, {{0, 1}}).nodes.size(), 5u);
  EXPECT_EQ(recent.found_count(), 3);
}

TEST(RecentOrders, ForgetTheOneThatWasNotAskedForTheLongest) {
  RecentOrders recent;
  for (int nodes = 1; nodes <= RecentOrders::kKept; ++nodes) recent.Find(nodes, {});
  recent.Find(1, {});
  recent.Find(RecentOrders::kKept + 1, {});
  EXPECT_EQ(recent.found_count(), RecentOrders::kKept + 1);
  recent.Find(1, {});
  EXPECT_EQ(recent.found_count(), RecentOrders::kKept + 1);
  recent.Find(2, {});
  EXPECT_EQ(recent.found_count(), RecentOrders::kKept + 2);
}

}  // namespace
}  // namespace palpate::fem
