// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/sparse/substitution.hpp"

#include <algorithm>

#include "libs/core/index.hpp"

namespace palpate::fem::internal {

namespace {

using dense::kTile;

/// Right-hand sides that pass a front together, and such blocks that pass it one after the other
/// while its factor is in the cache.
constexpr int kBlockColumns = 2 * kTile;
constexpr int kMostBlocks = 4;

}  // namespace

Substitution::Substitution(const FrontTree& tree, const FrontSchedule& schedule,
                           const dense::FrontKernels& kernels, ThreadTeam& team,
                           FactorStore& factor, int size)
    : tree_(tree),
      schedule_(schedule),
      kernels_(kernels),
      team_(team),
      factor_(factor),
      plan_(PlanSubstitution(tree, schedule, size)),
      size_{size},
      block_rows_{size + team.Size() * static_cast<long>(plan_.shared_rows.size()) + kTile} {
  rows_ = AlignedBuffer(static_cast<size_t>(block_rows_) * kBlockColumns * kMostBlocks);
  for (int thread = 0; thread < team.Size(); ++thread) {
    sums_.emplace_back(At(plan_.most_pivots * kTile));
  }
}

void Substitution::Solve(Eigen::Ref<Eigen::MatrixXd> columns, bool rounded) {
  constexpr Eigen::Index kAtOnce = kBlockColumns * kMostBlocks;
  for (Eigen::Index first = 0; first < columns.cols(); first += kAtOnce) {
    SolveBlocks(columns.middleCols(first, std::min(kAtOnce, columns.cols() - first)), rounded);
  }
}

/// A front that nothing has come to yet passes nothing on: of right-hand sides with few nonzeros
/// only the paths from these to the root are walked.
bool Substitution::IsZero(int f, const Block& block) const {
  const double* row = block.rows + 3L * tree_.fronts()[At(f)].first_node * block.width;
  return std::all_of(row, row + static_cast<long>(tree_.fronts()[At(f)].Pivots()) * block.width,
                     [](double value) { return value == 0.0; });
}

void Substitution::Forward(int f, const Block& block) {
  if (IsZero(f, block)) return;
  if (block.rounded) {
    Forward(kernels_.rounded, factor_.Rounded(f), f, block);
  } else {
    Forward(kernels_.exact, factor_.Panel(f), f, block);
  }
}

void Substitution::Backward(int f, const Block& block, int thread) {
  if (block.rounded) {
    Backward(kernels_.rounded, factor_.Rounded(f), f, block, thread);
  } else {
    Backward(kernels_.exact, factor_.Panel(f), f, block, thread);
  }
}

template <typename Value>
void Substitution::Forward(const dense::SubstitutionKernelsOf<Value>& kernels,
                           const dense::FactorPanelOf<Value>& factor, int f, const Block& block) {
  const int first = 3 * tree_.fronts()[At(f)].first_node;
  double* pivot_rows = block.rows + static_cast<long>(first) * block.width;
  const double* inverse = factor_.inverse() + first;
  const int* below_rows = plan_.forward_rows[At(f)].data();
  if (block.width == 1) {
    kernels.solve_forward_one(factor, inverse, pivot_rows, below_rows, block.rows);
  } else {
    kernels.solve_forward(factor, inverse, block.width, pivot_rows, below_rows, block.rows);
  }
}

template <typename Value>
void Substitution::Backward(const dense::SubstitutionKernelsOf<Value>& kernels,
                            const dense::FactorPanelOf<Value>& factor, int f, const Block& block,
                            int thread) {
  const int first = 3 * tree_.fronts()[At(f)].first_node;
  double* pivot_rows = block.rows + static_cast<long>(first) * block.width;
  const double* inverse = factor_.inverse() + first;
  const int* below_rows = tree_.fronts()[At(f)].below_rows.data();
  if (block.width == 1) {
    kernels.solve_backward_one(factor, inverse, pivot_rows, below_rows, block.rows,
                               sums_[At(thread)].data());
  } else {
    kernels.solve_backward(factor, inverse, block.width, pivot_rows, below_rows, block.rows);
  }
}

/// The front's rows of the columns of a block, row after row.
void Substitution::Read(int f, const Block& block,
                        const Eigen::Ref<const Eigen::MatrixXd>& columns) const {
  const int first = 3 * tree_.fronts()[At(f)].first_node;
  for (int row = first; row < first + tree_.fronts()[At(f)].Pivots(); ++row) {
    double* target = block.rows + static_cast<long>(row) * block.width;
    for (int c = 0; c < block.count; ++c) target[c] = columns(row, block.first + c);
    std::fill(target + block.count, target + block.width, 0.0);
  }
}

void Substitution::Write(int f, const Block& block, Eigen::Ref<Eigen::MatrixXd> columns) const {
  const int first = 3 * tree_.fronts()[At(f)].first_node;
  for (int row = first; row < first + tree_.fronts()[At(f)].Pivots(); ++row) {
    const double* source = block.rows + static_cast<long>(row) * block.width;
    for (int c = 0; c < block.count; ++c) columns(row, block.first + c) = source[c];
  }
}

/// What the threads' own fronts subtract from the rows of those that all share.
void Substitution::AddShares(const Block& block) const {
  const auto shares = static_cast<long>(plan_.shared_rows.size());
  for (long k = 0; k < shares; ++k) {
    const long row = plan_.shared_rows[At(k)];
    double* target = block.rows + row * block.width;
    for (int t = 0; t < team_.Size(); ++t) {
      const double* source = block.rows + (size_ + t * shares + k) * block.width;
      for (int c = 0; c < block.width; ++c) target[c] += source[c];
    }
  }
}

/// At most kBlockColumns kMostBlocks columns.
void Substitution::SolveBlocks(Eigen::Ref<Eigen::MatrixXd> columns, bool rounded) {
  const int count = static_cast<int>(columns.cols());
  Block blocks[kMostBlocks];
  int block_count = 0;
  for (int first = 0; first < count; first += kBlockColumns) {
    const int own = std::min(kBlockColumns, count - first);
    blocks[block_count] = {.rows = rows_.data() + block_rows_ * kBlockColumns * block_count,
                           .first = first,
                           .count = own,
                           .width = count == 1 ? 1 : dense::PaddedRows(own),
                           .rounded = rounded};
    ++block_count;
  }
  const std::span<const Block> all(blocks, static_cast<size_t>(block_count));
  team_.Run([&](int thread) {
    const std::vector<int>& own = schedule_.own[At(thread)];
    const auto shares = static_cast<long>(plan_.shared_rows.size());
    for (const Block& block : all) {
      std::fill_n(block.rows + (size_ + thread * shares) * block.width, shares * block.width, 0.0);
      for (const int f : own) Read(f, block, columns);
      if (thread != 0) continue;
      for (const int f : schedule_.together) Read(f, block, columns);
    }
    for (const int f : own) {
      for (const Block& block : all) Forward(f, block);
    }
  });
  SolveShared(all, columns);
  team_.Run([&](int thread) {
    const std::vector<int>& own = schedule_.own[At(thread)];
    for (auto f = own.rbegin(); f != own.rend(); ++f) {
      for (const Block& block : all) {
        Backward(*f, block, thread);
        Write(*f, block, columns);
      }
    }
  });
}

/// Down and up the fronts that all threads share, on one of them.
void Substitution::SolveShared(std::span<const Block> blocks, Eigen::Ref<Eigen::MatrixXd> columns) {
  for (const Block& block : blocks) AddShares(block);
  for (const int f : schedule_.together) {
    for (const Block& block : blocks) Forward(f, block);
  }
  for (auto f = schedule_.together.rbegin(); f != schedule_.together.rend(); ++f) {
    for (const Block& block : blocks) {
      Backward(*f, block, 0);
      Write(*f, block, columns);
    }
  }
}

}  // namespace palpate::fem::internal
