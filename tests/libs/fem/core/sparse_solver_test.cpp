// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/sparse/sparse_solver.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "libs/core/error.hpp"
#include "libs/fem/sparse/solver_settings.hpp"
#include "libs/linalg/cholesky.hpp"
#include "tests/libs/fem/core/laws.hpp"

namespace palpate::fem {
namespace {

/// A banded symmetric matrix of 3x3 blocks.
struct Banded {
  static constexpr int kNodes = 20;
  static constexpr int kSize = 3 * kNodes;
  static constexpr int kBand = 3;  ///< blocks, with that on the diagonal

  explicit Banded(double diagonal, unsigned seed) {
    std::mt19937 engine(seed);
    column_start.push_back(0);
    dense = Eigen::MatrixXd::Zero(kSize, kSize);
    for (int j = 0; j < kNodes; ++j) {
      for (int i = j; i < std::min(kNodes, j + kBand); ++i) {
        Eigen::Matrix3d block = laws::RandomVector(9, 1.0, &engine).reshaped(3, 3);
        if (i == j) {
          block = (block + block.transpose()).eval();
          block.diagonal().setConstant(diagonal);
        }
        row.push_back(i);
        values.insert(values.end(), block.data(), block.data() + kBlockEntries);
        dense.block<3, 3>(3 * j, 3 * i) = block.transpose();
        dense.block<3, 3>(3 * i, 3 * j) = block;
      }
      column_start.push_back(static_cast<int>(row.size()));
    }
  }
  BlockPattern Pattern() const { return {column_start, row, supernode_start}; }

  std::vector<int> column_start, row;
  std::vector<int> supernode_start{0, 1, 3, 8, 12, kNodes};
  std::vector<double> values;
  Eigen::MatrixXd dense;
};

void ExpectSolves(SparseSolver& solver, const Eigen::MatrixXd& dense, int columns) {
  std::mt19937 engine(8);
  const Eigen::MatrixXd b =
      laws::RandomVector(Banded::kSize * columns, 1.0, &engine).reshaped(Banded::kSize, columns);
  Eigen::MatrixXd x = b;
  solver.Solve(x);
  EXPECT_LE((dense * x - b).norm(), 1e-12 * b.norm());
  EXPECT_LE((x - linalg::SolveSymmetric(dense, b)).norm(), 1e-12 * x.norm());
}

TEST(SparseSolver, OfEachNameSolvesOneAndSeveralRightHandSides) {
  const Banded matrix(10.0, 1);
  ThreadTeam team(2);
  for (const std::string& name : SolverNames()) {
    SCOPED_TRACE(name);
    const auto solver = MakeSolver(name, matrix.Pattern(), team);
    EXPECT_EQ(solver->Name().substr(0, name.size()), name);
    ASSERT_TRUE(solver->Factorize(matrix.values).ok());
    for (const int columns : {1, 2, 8, 13}) ExpectSolves(*solver, matrix.dense, columns);
  }
}

TEST(SparseSolver, OfEachNameSaysThatAMatrixIsNotPositiveDefiniteAndRecovers) {
  const Banded indefinite(0.5, 1);
  const Banded good(10.0, 1);
  ThreadTeam team(1);
  for (const std::string& name : SolverNames()) {
    SCOPED_TRACE(name);
    const auto solver = MakeSolver(name, indefinite.Pattern(), team);
    EXPECT_EQ(solver->Factorize(indefinite.values).code(), StatusCode::kNotPositiveDefinite);
    ASSERT_TRUE(solver->Factorize(good.values).ok());
    ExpectSolves(*solver, good.dense, 1);
  }
}

TEST(SparseSolver, OfUnknownNameIsRefusedWithTheNearestOne) {
  const Banded matrix(10.0, 1);
  ThreadTeam team(1);
  EXPECT_THAT([&] { MakeSolver("multifrontl", matrix.Pattern(), team); },
              testing::ThrowsMessage<InputError>(testing::HasSubstr("multifrontal")));
}

TEST(CholmodSolver, SolvesColumnsOfALargerMatrix) {
  const Banded matrix(10.0, 1);
  const auto solver = MakeCholmodSolver(matrix.Pattern());
  ASSERT_TRUE(solver->Factorize(matrix.values).ok());
  Eigen::MatrixXd block = Eigen::MatrixXd::Ones(Banded::kSize + 5, 4);
  solver->Solve(block.block(2, 1, Banded::kSize, 2));
  const Eigen::VectorXd expected =
      linalg::SolveSymmetric(matrix.dense, Eigen::VectorXd(Eigen::VectorXd::Ones(Banded::kSize)));
  EXPECT_LE((block.col(1).segment(2, Banded::kSize) - expected).norm(), 1e-12);
  EXPECT_LE((block.col(2).segment(2, Banded::kSize) - expected).norm(), 1e-12);
  EXPECT_TRUE(block.col(0).isOnes(0.0) && block.col(3).isOnes(0.0));
  EXPECT_TRUE(block.topRows(2).isOnes(0.0) && block.bottomRows(3).isOnes(0.0));
}

TEST(CholmodSolver, FactorisesAgainWithOtherValues) {
  const Banded first(10.0, 1);
  const Banded second(20.0, 2);
  const auto solver = MakeCholmodSolver(first.Pattern());
  ASSERT_TRUE(solver->Factorize(first.values).ok());
  ASSERT_TRUE(solver->Factorize(second.values).ok());
  ExpectSolves(*solver, second.dense, 3);
}

TEST(CholmodSolver, RefusesNaNAnywhere) {
  const Banded good(10.0, 1);
  const auto solver = MakeCholmodSolver(good.Pattern());
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    for (const size_t block : {size_t{0}, size_t{1}, good.row.size() / 2, good.row.size() - 1}) {
      const size_t at = kBlockEntries * block + 5;  // below the diagonal
      std::vector<double> values = good.values;
      values[at] = bad;
      EXPECT_FALSE(solver->Factorize(values).ok()) << bad << " at " << at;
    }
  }
  ASSERT_TRUE(solver->Factorize(good.values).ok());
  ExpectSolves(*solver, good.dense, 1);
}

TEST(CholmodSolverDeathTest, DoesNotSolveWithoutAFactor) {
  const Banded indefinite(0.5, 1);
  const auto solver = MakeCholmodSolver(indefinite.Pattern());
  EXPECT_FALSE(solver->Factorize(indefinite.values).ok());
  Eigen::MatrixXd column = Eigen::MatrixXd::Ones(Banded::kSize, 1);
  EXPECT_DEATH(solver->Solve(column), "has_factor_");
}

TEST(CholmodSolver, TellsTheSizeOfItsFactor) {
  const Banded matrix(10.0, 1);
  const auto solver = MakeCholmodSolver(matrix.Pattern());
  // A band fills no more than itself.
  EXPECT_EQ(solver->FactorNonzeros(), 9 * matrix.row.size() - 3 * Banded::kNodes);
  ASSERT_TRUE(solver->Factorize(matrix.values).ok());
  EXPECT_GT(solver->FactorFlops(), static_cast<double>(Banded::kSize));
  EXPECT_GT(solver->MemoryBytes(), 8 * matrix.row.size());
}

}  // namespace
}  // namespace palpate::fem
