// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/benchmarks/solver_bench.hpp"

#include <cmath>

#include "libs/core/error.hpp"
#include "libs/core/text.hpp"

namespace palpate::benchmarks {

namespace {

/// Relative; some digits are lost to the condition of the matrix.
constexpr double kLargestError = 1e-6;

}  // namespace

SolverBench::SolverBench(const Contender& contender, const fem::StiffnessMatrix& matrix)
    : team_(contender.settings.threads),
      matrix_(matrix),
      solver_(MakeContender(contender, matrix.Pattern(), team_)) {}

void SolverBench::Factorize() {
  const Status status = solver_->Factorize(matrix_.Values());
  has_factor_ = status.ok();
  if (!status.ok()) throw RunError("the tangent has no factor: " + status.message());
}

void SolverBench::SetColumns(int count, int calls) {
  right_hand_sides_.resize(matrix_.Size(), count);
  for (Eigen::Index row = 0; row < matrix_.Size(); ++row) {
    for (Eigen::Index column = 0; column < count; ++column) {
      right_hand_sides_(row, column) = std::sin(static_cast<double>(row * (column + 1)));
    }
  }
  columns_.assign(static_cast<size_t>(calls), right_hand_sides_);
  next_ = 0;
}

void SolverBench::SolveNext() { solver_->Solve(columns_.at(next_++)); }

void SolverBench::CheckLast() const {
  const Eigen::MatrixXd& solution = columns_.at(next_ - 1);
  for (Eigen::Index column = 0; column < solution.cols(); ++column) {
    const Eigen::VectorXd wanted = right_hand_sides_.col(column);
    const double error = (matrix_.Times(solution.col(column)) - wanted).norm() / wanted.norm();
    if (!(error <= kLargestError)) {
      throw RunError(solver_->Name() + " misses by " + FormatNumber(error) + " of the right side");
    }
  }
}

}  // namespace palpate::benchmarks
