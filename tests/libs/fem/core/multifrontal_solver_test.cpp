// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <limits>
#include <memory>
#include <string>

#include "libs/fem/sparse/sparse_solver.hpp"
#include "libs/fem/stiffness_matrix.hpp"
#include "tests/libs/fem/core/laws.hpp"

namespace palpate::fem {
namespace {

constexpr int kSide = 9;
constexpr int kNodes = kSide * kSide * kSide;

/// Random blocks between neighbours of a cubic grid, made positive definite by the diagonal.
StiffnessMatrix MakeGridMatrix(double diagonal, unsigned seed) {
  NodePairs pairs;
  for (int n = 0; n < kNodes; ++n) {
    if (n % kSide + 1 < kSide) pairs.emplace_back(n, n + 1);
    if (n / kSide % kSide + 1 < kSide) pairs.emplace_back(n, n + kSide);
    if (n + kSide * kSide < kNodes) pairs.emplace_back(n, n + kSide * kSide);
  }
  Eigen::Matrix<bool, 3, Eigen::Dynamic> fixed(3, kNodes);
  fixed.setConstant(false);
  StiffnessMatrix matrix(fixed, pairs);
  std::mt19937 engine(seed);
  for (const auto& [a, b] : pairs) {
    const Eigen::Matrix3d block = laws::RandomVector(9, 1.0, &engine).reshaped(3, 3);
    matrix.Add(matrix.Slot(a, b), block);
  }
  for (int n = 0; n < kNodes; ++n) {
    matrix.Add(matrix.Slot(n, n), Eigen::Matrix3d(diagonal * Eigen::Matrix3d::Identity()));
  }
  return matrix;
}

Eigen::MatrixXd RandomColumns(int rows, int columns) {
  std::mt19937 engine(5);
  return laws::RandomVector(rows * columns, 1.0, &engine).reshaped(rows, columns);
}

class MultifrontalSolver : public testing::TestWithParam<InstructionSet> {};

TEST_P(MultifrontalSolver, SolvesLikeCholmod) {
  const StiffnessMatrix matrix = MakeGridMatrix(25.0, 1);
  ThreadTeam team(1);
  const auto solver = MakeMultifrontalSolver(matrix.Pattern(), team, GetParam());
  const auto reference = MakeCholmodSolver(matrix.Pattern());
  ASSERT_TRUE(solver->Factorize(matrix.Values()).ok());
  ASSERT_TRUE(reference->Factorize(matrix.Values()).ok());
  for (const int columns : {1, 7, 8, 9, 16, 21, 64, 90}) {
    const Eigen::MatrixXd b = RandomColumns(matrix.Size(), columns);
    Eigen::MatrixXd x = b;
    Eigen::MatrixXd expected = b;
    solver->Solve(x);
    reference->Solve(expected);
    EXPECT_LE((x - expected).norm(), 1e-12 * expected.norm()) << columns << " columns";
    EXPECT_LE((matrix.Times(x.col(0)) - b.col(0)).norm(), 1e-12 * b.col(0).norm());
  }
}

/// Of such columns most of the fronts see nothing on the way down.
TEST_P(MultifrontalSolver, SolvesForColumnsWithFewNonzeros) {
  const StiffnessMatrix matrix = MakeGridMatrix(25.0, 1);
  for (const int threads : {1, 2}) {
    ThreadTeam team(threads);
    const auto solver = MakeMultifrontalSolver(matrix.Pattern(), team, GetParam());
    ASSERT_TRUE(solver->Factorize(matrix.Values()).ok());
    for (const int step : {1, 97, 271}) {
      constexpr int kColumns = 8;
      Eigen::MatrixXd b = Eigen::MatrixXd::Zero(matrix.Size(), kColumns);
      for (int c = 0; c + 1 < kColumns; ++c) b(c * step, c) = 1.0;
      Eigen::MatrixXd x = b;
      solver->Solve(x);
      for (int c = 0; c < kColumns; ++c) {
        EXPECT_LE((matrix.Times(x.col(c)) - b.col(c)).norm(), 1e-14) << c << " of step " << step;
      }
      EXPECT_TRUE(x.col(kColumns - 1).isZero(0.0)) << "a column of zeros";
    }
  }
}

/// A single front, so that nothing but the end of its memory lies behind its last tile.
TEST_P(MultifrontalSolver, SolvesWithAFrontOfAnySize) {
  ThreadTeam team(1);
  for (int nodes = 1; nodes <= 9; ++nodes) {
    std::vector<int> column_start{0};
    std::vector<int> row;
    std::vector<double> values;
    const Eigen::MatrixXd root = RandomColumns(3 * nodes, 3 * nodes);
    const Eigen::MatrixXd dense =
        root * root.transpose() + Eigen::MatrixXd::Identity(3 * nodes, 3 * nodes);
    for (int column = 0; column < nodes; ++column) {
      for (int a = column; a < nodes; ++a) {
        const Eigen::Matrix3d block = dense.block<3, 3>(3 * a, 3 * column);
        row.push_back(a);
        values.insert(values.end(), block.data(), block.data() + kBlockEntries);
      }
      column_start.push_back(static_cast<int>(row.size()));
    }
    const std::vector<int> supernode_start{0, nodes};
    const auto solver =
        MakeMultifrontalSolver({column_start, row, supernode_start}, team, GetParam());
    ASSERT_TRUE(solver->Factorize(values).ok());
    for (const int columns : {1, 3, 12}) {
      const Eigen::MatrixXd b = RandomColumns(3 * nodes, columns);
      Eigen::MatrixXd x = b;
      solver->Solve(x);
      EXPECT_LE((dense * x - b).norm(), 1e-12 * b.norm()) << nodes << " nodes, " << columns;
    }
    solver->KeepSinglePrecision();
    ASSERT_TRUE(solver->Factorize(values).ok());
    for (const int columns : {1, 3, 12}) {
      const Eigen::MatrixXd b = RandomColumns(3 * nodes, columns);
      Eigen::MatrixXd x = b;
      solver->SolveSingle(x);
      EXPECT_LE((dense * x - b).norm(), 1e-4 * b.norm()) << nodes << " nodes, rounded " << columns;
    }
  }
}

/// To what single precision of the factor leaves, and exactly where the residual corrects it.
TEST_P(MultifrontalSolver, SolvesByARoundedFactor) {
  for (const int threads : {1, 2}) {
    const StiffnessMatrix matrix = MakeGridMatrix(25.0, 1);
    ThreadTeam team(threads);
    const auto solver = MakeMultifrontalSolver(matrix.Pattern(), team, GetParam());
    ASSERT_TRUE(solver->Factorize(matrix.Values()).ok());
    const Eigen::MatrixXd all = RandomColumns(matrix.Size(), 80);
    const std::vector<int> counts{1, 3, 12, 80};
    std::vector<Eigen::MatrixXd> exact;
    for (const int columns : counts) {
      exact.emplace_back(all.leftCols(columns));
      solver->Solve(exact.back());
    }
    solver->KeepSinglePrecision();
    for (size_t k = 0; k < counts.size(); ++k) {
      Eigen::MatrixXd x = all.leftCols(counts[k]);
      solver->SolveSingle(x);
      EXPECT_EQ(x, exact[k]) << "rounded from the next factorisation on";
    }
    ASSERT_TRUE(solver->Factorize(matrix.Values()).ok());
    for (size_t k = 0; k < counts.size(); ++k) {
      SCOPED_TRACE(counts[k]);
      const Eigen::MatrixXd b = all.leftCols(counts[k]);
      Eigen::MatrixXd x = b;
      solver->SolveSingle(x);
      EXPECT_LE((x - exact[k]).norm(), 1e-6 * exact[k].norm());
      EXPECT_GE((x - exact[k]).norm(), 1e-12 * exact[k].norm()) << "not rounded";
      for (int step = 0; step < 2; ++step) {
        Eigen::MatrixXd left(b.rows(), b.cols());
        for (Eigen::Index c = 0; c < b.cols(); ++c) left.col(c) = b.col(c) - matrix.Times(x.col(c));
        solver->SolveSingle(left);
        x += left;
      }
      EXPECT_LE((x - exact[k]).norm(), 1e-13 * exact[k].norm());
      Eigen::MatrixXd again = b;
      solver->Solve(again);
      EXPECT_EQ(again, exact[k]);
    }
  }
}

TEST_P(MultifrontalSolver, SaysThatAMatrixIsNotPositiveDefinite) {
  const StiffnessMatrix good = MakeGridMatrix(25.0, 1);
  const StiffnessMatrix indefinite = MakeGridMatrix(2.0, 1);
  for (const int threads : {1, 2}) {
    ThreadTeam team(threads);
    const auto solver = MakeMultifrontalSolver(good.Pattern(), team, GetParam());
    EXPECT_EQ(solver->Factorize(indefinite.Values()).code(), StatusCode::kNotPositiveDefinite);
    ASSERT_TRUE(solver->Factorize(good.Values()).ok());
    const Eigen::VectorXd b = RandomColumns(good.Size(), 1);
    Eigen::MatrixXd x = b;
    solver->Solve(x);
    EXPECT_LE((good.Times(x.col(0)) - b).norm(), 1e-12 * b.norm());
  }
}

TEST_P(MultifrontalSolver, RefusesNaNAnywhere) {
  StiffnessMatrix matrix = MakeGridMatrix(25.0, 1);
  ThreadTeam team(1);
  const auto solver = MakeMultifrontalSolver(matrix.Pattern(), team, GetParam());
  const size_t blocks = matrix.Pattern().row.size();
  for (const size_t block : {size_t{0}, size_t{1}, blocks / 2, blocks - 1}) {
    double& value = matrix.Values()[kBlockEntries * block + 5];  // below the diagonal
    const double before = value;
    for (const double bad :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
      value = bad;
      EXPECT_EQ(solver->Factorize(matrix.Values()).code(), StatusCode::kInvalidInput) << block;
    }
    value = before;
  }
  EXPECT_TRUE(solver->Factorize(matrix.Values()).ok());
}

INSTANTIATE_TEST_SUITE_P(Kernels, MultifrontalSolver, testing::ValuesIn(AvailableInstructionSets()),
                         [](const auto& set) { return std::string(ToString(set.param)); });

TEST(MultifrontalThreads, GiveTheSameSolution) {
  const StiffnessMatrix matrix = MakeGridMatrix(25.0, 3);
  const Eigen::MatrixXd b = RandomColumns(matrix.Size(), 11);
  Eigen::MatrixXd alone;
  for (const int threads : {1, 2, 3, 4}) {
    ThreadTeam team(threads);
    const auto solver = MakeMultifrontalSolver(matrix.Pattern(), team);
    ASSERT_TRUE(solver->Factorize(matrix.Values()).ok());
    Eigen::MatrixXd x = b;
    solver->Solve(x);
    if (threads == 1) alone = x;
    EXPECT_LE((x - alone).norm(), 1e-12 * alone.norm()) << threads << " threads";
  }
}

TEST(MultifrontalDeathTest, DoesNotSolveWithoutAFactor) {
  const StiffnessMatrix indefinite = MakeGridMatrix(2.0, 1);
  ThreadTeam team(1);
  const auto solver = MakeMultifrontalSolver(indefinite.Pattern(), team);
  EXPECT_FALSE(solver->Factorize(indefinite.Values()).ok());
  Eigen::MatrixXd column = Eigen::MatrixXd::Ones(indefinite.Size(), 1);
  EXPECT_DEATH(solver->Solve(column), "has_factor_");
}

}  // namespace
}  // namespace palpate::fem
