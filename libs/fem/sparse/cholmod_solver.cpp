// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <cmath>
#include <vector>

#include "libs/core/check.hpp"
#include "libs/core/index.hpp"
#include "libs/fem/sparse/cholmod_context.hpp"
#include "libs/fem/sparse/sparse_solver.hpp"

namespace palpate::fem {

namespace {

/// BLAS lets NaN pass as a pivot, so that it has to be found before.
bool AllFinite(std::span<const double> values) {
  bool finite = true;
  for (const double value : values) finite &= std::isfinite(value);
  return finite;
}

/// Columns are merged into one supernode up to these numbers of columns as long as less than these
/// fractions of it are zeros: twice to three times CHOLMOD's numbers, because each pair of
/// supernodes costs calls that the small fronts of our meshes do not pay for. Fastest of eleven
/// choices on the mesh of the paper, tet4 and tet10.
void UseLargeSupernodes(cholmod_common* common) {
  common->nrelax[0] = 12;
  common->nrelax[1] = 48;
  common->nrelax[2] = 96;
  common->zrelax[0] = 0.8;
  common->zrelax[1] = 0.2;
  common->zrelax[2] = 0.05;
}

class CholmodSolver final : public SparseSolver {
 public:
  CholmodSolver(const BlockPattern& pattern, CholmodMethod method)
      : size_{pattern.Size()}, method_{method} {
    ExpandBlocks(pattern);
    cholmod_common* common = context_.get();
    const bool supernodal = method == CholmodMethod::kSupernodal;
    common->supernodal = supernodal ? CHOLMOD_SUPERNODAL : CHOLMOD_SIMPLICIAL;
    common->final_ll = 1;
    common->quick_return_if_not_posdef = 1;
    common->nmethods = 1;
    common->method[0].ordering = CHOLMOD_NATURAL;  // the pattern is in its final order already
    common->postorder = 0;
    UseLargeSupernodes(common);
    cholmod_sparse matrix = View(CHOLMOD_PATTERN);
    factor_ = cholmod_analyze(&matrix, common);
    PALPATE_CHECK(factor_ != nullptr, common->status);
    factor_nonzeros_ = static_cast<size_t>(common->lnz);
    factor_flops_ = common->fl;
  }

  ~CholmodSolver() override {
    cholmod_free_dense(&solution_, context_.get());
    cholmod_free_dense(&workspace_y_, context_.get());
    cholmod_free_dense(&workspace_e_, context_.get());
    cholmod_free_factor(&factor_, context_.get());
  }

  Status Factorize(std::span<const double> values) override {
    has_factor_ = false;
    if (!AllFinite(values)) return {StatusCode::kInvalidInput, "the matrix is not finite"};
    PALPATE_CHECK(values.size() == block_entries_, values.size(), block_entries_);
    for (size_t k = 0; k < source_.size(); ++k) values_[k] = values[At(source_[k])];
    cholmod_sparse matrix = View(CHOLMOD_REAL);
    {
      const internal::OneThread one_thread;
      cholmod_factorize(&matrix, factor_, context_.get());
    }
    const int status = context_.get()->status;
    if (status == CHOLMOD_NOT_POSDEF || factor_->minor < factor_->n) {
      return {StatusCode::kNotPositiveDefinite, {}};
    }
    if (status != CHOLMOD_OK) {
      return {StatusCode::kInvalidInput, "CHOLMOD status " + std::to_string(status)};
    }
    has_factor_ = true;
    return Status::Ok();
  }

  void Solve(Eigen::Ref<Eigen::MatrixXd> columns) override {
    PALPATE_CHECK(has_factor_);
    PALPATE_CHECK(columns.rows() == size_, columns.rows(), size_);
    if (columns.cols() == 0) return;
    const internal::SolveMemoryScope scope;
    cholmod_dense right_hand_side{};
    right_hand_side.nrow = static_cast<size_t>(columns.rows());
    right_hand_side.ncol = static_cast<size_t>(columns.cols());
    right_hand_side.d = static_cast<size_t>(columns.outerStride());
    right_hand_side.nzmax = right_hand_side.d * right_hand_side.ncol;
    right_hand_side.x = columns.data();
    right_hand_side.xtype = CHOLMOD_REAL;
    right_hand_side.dtype = CHOLMOD_DOUBLE;
    const internal::OneThread one_thread;
    const int solved = cholmod_solve2(CHOLMOD_A, factor_, &right_hand_side, nullptr, &solution_,
                                      nullptr, &workspace_y_, &workspace_e_, context_.get());
    PALPATE_CHECK(solved == 1, context_.get()->status);
    columns = Eigen::Map<const Eigen::MatrixXd>(static_cast<const double*>(solution_->x),
                                                columns.rows(), columns.cols());
  }

  std::string Name() const override {
    return method_ == CholmodMethod::kSupernodal ? "cholmod_supernodal" : "cholmod_simplicial";
  }
  size_t FactorNonzeros() const override { return factor_nonzeros_; }
  size_t MemoryBytes() const override { return context_.memory_inuse(); }
  double FactorFlops() const override { return factor_flops_; }

 private:
  /// The scalar pattern of the lower triangle, and where each of its values lies in the blocks.
  void ExpandBlocks(const BlockPattern& pattern) {
    column_start_.push_back(0);
    for (int column = 0; column < pattern.NodeCount(); ++column) {
      const auto node = static_cast<size_t>(column);
      for (int c = 0; c < 3; ++c) {
        for (int k = pattern.column_start[node]; k < pattern.column_start[node + 1]; ++k) {
          const int row = pattern.row[At(k)];
          for (int r = row == column ? c : 0; r < 3; ++r) {
            row_.push_back(3 * row + r);
            source_.push_back(kBlockEntries * k + 3 * c + r);
          }
        }
        column_start_.push_back(static_cast<int>(row_.size()));
      }
    }
    values_.resize(row_.size());
    block_entries_ = kBlockEntries * pattern.row.size();
  }

  /// The matrix without a copy; CHOLMOD takes non-const pointers but does not write through them.
  cholmod_sparse View(int kind) {
    cholmod_sparse matrix{};
    matrix.nrow = matrix.ncol = static_cast<size_t>(size_);
    matrix.nzmax = row_.size();
    matrix.p = column_start_.data();
    matrix.i = row_.data();
    matrix.x = values_.data();
    matrix.stype = -1;
    matrix.itype = CHOLMOD_INT;
    matrix.xtype = kind;
    matrix.dtype = CHOLMOD_DOUBLE;
    matrix.sorted = 1;
    matrix.packed = 1;
    return matrix;
  }

  internal::CholmodContext context_;
  int size_;
  CholmodMethod method_;
  std::vector<int> column_start_, row_;  ///< scalar, lower triangle
  std::vector<int> source_;              ///< [nonzeros] place in the block values
  std::vector<double> values_;           ///< [nonzeros]
  size_t block_entries_ = 0;
  cholmod_factor* factor_ = nullptr;
  cholmod_dense* solution_ = nullptr;
  cholmod_dense* workspace_y_ = nullptr;
  cholmod_dense* workspace_e_ = nullptr;
  size_t factor_nonzeros_ = 0;
  double factor_flops_ = 0.0;
  bool has_factor_ = false;
};

}  // namespace

std::unique_ptr<SparseSolver> MakeCholmodSolver(const BlockPattern& pattern, CholmodMethod method) {
  return std::make_unique<CholmodSolver>(pattern, method);
}

}  // namespace palpate::fem
