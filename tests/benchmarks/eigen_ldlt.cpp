// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/benchmarks/eigen_ldlt.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <vector>

#include "libs/core/check.hpp"

namespace palpate::benchmarks {

namespace {

using SparseMatrix = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;

class EigenLdlt final : public fem::SparseSolver {
 public:
  explicit EigenLdlt(const fem::BlockPattern& pattern)
      : block_entries_(fem::kBlockEntries * pattern.row.size()) {
    ExpandBlocks(pattern);
    ldlt_.analyzePattern(matrix_);
  }

  Status Factorize(std::span<const double> values) override {
    PALPATE_CHECK(values.size() == block_entries_, values.size(), block_entries_);
    for (size_t k = 0; k < source_.size(); ++k) {
      matrix_.valuePtr()[k] = values[static_cast<size_t>(source_[k])];
    }
    ldlt_.factorize(matrix_);
    has_factor_ = ldlt_.info() == Eigen::Success && ldlt_.vectorD().minCoeff() > 0.0;
    if (has_factor_) return Status::Ok();
    return {StatusCode::kNotPositiveDefinite, {}};
  }

  void Solve(Eigen::Ref<Eigen::MatrixXd> columns) override {
    PALPATE_CHECK(has_factor_);
    columns = ldlt_.solve(columns).eval();
  }

  std::string Name() const override { return "eigen_ldlt"; }

  /// L without its unit diagonal, and D.
  size_t FactorNonzeros() const override {
    return static_cast<size_t>(Lower().nonZeros() + Lower().cols());
  }
  size_t MemoryBytes() const override {
    const auto entries = static_cast<size_t>(Lower().nonZeros());
    const auto size = static_cast<size_t>(Lower().cols());
    return entries * (sizeof(double) + sizeof(int)) + size * (sizeof(double) + sizeof(int));
  }
  /// Each entry of a column of L, its diagonal included, meets each: a multiplication and an
  /// addition for one half of the pairs.
  double FactorFlops() const override {
    const int* start = Lower().outerIndexPtr();
    double flops = 0.0;
    for (Eigen::Index column = 0; column < Lower().cols(); ++column) {
      flops += std::pow(1.0 + start[column + 1] - start[column], 2);
    }
    return flops;
  }

 private:
  const SparseMatrix& Lower() const { return ldlt_.matrixL().nestedExpression(); }

  /// The lower triangle by single rows, and where each of its values lies in the blocks.
  void ExpandBlocks(const fem::BlockPattern& pattern) {
    std::vector<int> start{0};
    std::vector<int> rows;
    for (int column = 0; column < pattern.Size(); ++column) {
      const auto node = static_cast<size_t>(column / 3);
      const int c = column % 3;
      for (int k = pattern.column_start[node]; k < pattern.column_start[node + 1]; ++k) {
        const int first_row = 3 * pattern.row[static_cast<size_t>(k)];
        for (int r = std::max(0, column - first_row); r < 3; ++r) {
          rows.push_back(first_row + r);
          source_.push_back(fem::kBlockEntries * k + 3 * c + r);
        }
      }
      start.push_back(static_cast<int>(rows.size()));
    }
    matrix_.resize(pattern.Size(), pattern.Size());
    matrix_.resizeNonZeros(static_cast<Eigen::Index>(rows.size()));
    std::copy(start.begin(), start.end(), matrix_.outerIndexPtr());
    std::copy(rows.begin(), rows.end(), matrix_.innerIndexPtr());
    std::fill_n(matrix_.valuePtr(), rows.size(), 1.0);
  }

  size_t block_entries_;
  SparseMatrix matrix_;      ///< lower triangle
  std::vector<int> source_;  ///< [nonzeros] place in the block values
  Eigen::SimplicialLDLT<SparseMatrix, Eigen::Lower, Eigen::AMDOrdering<int>> ldlt_;
  bool has_factor_ = false;
};

}  // namespace

std::unique_ptr<fem::SparseSolver> MakeEigenLdlt(const fem::BlockPattern& pattern) {
  return std::make_unique<EigenLdlt>(pattern);
}

}  // namespace palpate::benchmarks
