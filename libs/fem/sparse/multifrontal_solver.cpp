// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <atomic>
#include <cmath>
#include <vector>

#include "libs/core/check.hpp"
#include "libs/fem/sparse/aligned_buffer.hpp"
#include "libs/fem/sparse/dense/front_kernels.hpp"
#include "libs/fem/sparse/front_schedule.hpp"
#include "libs/fem/sparse/front_tree.hpp"
#include "libs/fem/sparse/sparse_solver.hpp"
#include "libs/fem/sparse/substitution_plan.hpp"

namespace palpate::fem {

namespace {

using dense::kTile;
using dense::Panel;
using dense::Update;
using internal::Front;

/// Columns of a front that are eliminated before the others get to know of it.
constexpr int kPassColumns = 96;
/// Rows that a thread takes at a time of a front that all work on.
constexpr int kSharedRows = 6 * kTile;

size_t At(int index) { return static_cast<size_t>(index); }

class MultifrontalSolver final : public SparseSolver {
 public:
  MultifrontalSolver(const BlockPattern& pattern, ThreadTeam& team, InstructionSet instruction_set)
      : tree_(pattern),
        schedule_(internal::ScheduleFronts(tree_, team.Size())),
        plan_(internal::PlanSubstitution(tree_, schedule_, pattern.Size())),
        kernels_(dense::SelectFrontKernels(instruction_set)),
        team_(team),
        instruction_set_(instruction_set),
        size_{pattern.Size()},
        block_entries_{kBlockEntries * pattern.row.size()} {
    size_t factor = 0;
    for (const Front& front : tree_.fronts()) {
      factor_offset_.push_back(factor);
      factor += dense::FactorPanel::Size(front.Pivots(), front.Below());
    }
    // The last tile is read as a whole.
    factor_ = internal::AlignedBuffer(factor + kTile * kTile);
    for (const std::vector<int>& own : schedule_.own) panels_.push_back(RoomForPanels(own));
    shared_panel_ = RoomForPanels(schedule_.together);
    updates_ = internal::AlignedBuffer(schedule_.update_size);
    inverse_.resize(At(size_ + kTile));
    const auto shares = static_cast<long>(plan_.shared_rows.size());
    rows_ = internal::AlignedBuffer(At(static_cast<int>(size_ + team.Size() * shares + kTile)) * 2 *
                                    kTile);
    for (int thread = 0; thread < team.Size(); ++thread) {
      below_.emplace_back(At(dense::PaddedRows(plan_.most_below)));
    }
  }

  Status Factorize(std::span<const double> values) override {
    PALPATE_CHECK(values.size() == block_entries_, values.size(), block_entries_);
    has_factor_ = false;
    positive_.store(true, std::memory_order_relaxed);
    team_.Run([&](int thread) {
      for (const int f : schedule_.own[At(thread)])
        FactorFront(f, values.data(), panels_[At(thread)]);
      team_.Barrier();
      for (const int f : schedule_.together) FactorFrontTogether(f, values.data(), thread);
    });
    has_factor_ = positive_.load(std::memory_order_relaxed);
    has_rounded_ = has_factor_ && rounded_.size() > 0;
    if (has_factor_) return Status::Ok();
    const bool finite =
        std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
    return finite ? Status(StatusCode::kNotPositiveDefinite, {})
                  : Status(StatusCode::kInvalidInput, "the matrix is not finite");
  }

  void Solve(Eigen::Ref<Eigen::MatrixXd> columns) override {
    PALPATE_CHECK(has_factor_);
    PALPATE_CHECK(columns.rows() == size_, columns.rows(), size_);
    for (Eigen::Index first = 0; first < columns.cols(); first += 2 * kTile) {
      SolveColumns(
          columns.middleCols(first, std::min<Eigen::Index>(2 * kTile, columns.cols() - first)),
          false);
    }
  }

  void KeepRounded() override {
    if (rounded_.size() == 0) {
      rounded_ = internal::AlignedBufferOf<float>(factor_.size());
      has_rounded_ = false;
    }
  }

  void SolveRounded(Eigen::Ref<Eigen::VectorXd> column) override {
    PALPATE_CHECK(has_factor_);
    PALPATE_CHECK(column.size() == size_, column.size(), size_);
    SolveColumns(column, has_rounded_);
  }

  std::string Name() const override {
    return "multifrontal_" + std::string(ToString(instruction_set_));
  }
  size_t FactorNonzeros() const override {
    size_t nonzeros = 0;
    for (const Front& front : tree_.fronts()) {
      nonzeros += At(front.Pivots() * (front.Pivots() + 1) / 2 + front.Pivots() * front.Below());
    }
    return nonzeros;
  }
  size_t MemoryBytes() const override {
    size_t bytes = factor_.bytes() + rounded_.bytes() + updates_.bytes() + rows_.bytes() +
                   shared_panel_.bytes();
    for (const internal::AlignedBuffer& panel : panels_) bytes += panel.bytes();
    return bytes + sizeof(double) * inverse_.size();
  }
  double FactorFlops() const override {
    double multiply_adds = 0.0;
    for (const Front& front : tree_.fronts()) multiply_adds += front.MultiplyAdds();
    return 2.0 * multiply_adds;
  }

 private:
  const Front& FrontOf(int f) const { return tree_.fronts()[At(f)]; }
  /// The largest panel of these fronts has room in it.
  internal::AlignedBuffer RoomForPanels(const std::vector<int>& fronts) const {
    size_t size = 0;
    for (const int f : fronts) size = std::max(size, FrontOf(f).PanelSize());
    return internal::AlignedBuffer(size);
  }
  Panel PanelOf(int f, internal::AlignedBuffer& room) const {
    const Front& front = FrontOf(f);
    return {room.data(), front.PanelStride(), front.Pivots(), front.Below()};
  }
  dense::FactorPanel FactorOf(int f) {
    return {factor_.data() + factor_offset_[At(f)], FrontOf(f).Pivots(), FrontOf(f).Below()};
  }
  dense::RoundedPanel RoundedOf(int f) {
    return {rounded_.data() + factor_offset_[At(f)], FrontOf(f).Pivots(), FrontOf(f).Below()};
  }
  Update UpdateOf(int f) {
    return {updates_.data() + schedule_.update_offset[At(f)], FrontOf(f).UpdateStride()};
  }

  void FactorFront(int f, const double* values, internal::AlignedBuffer& room);
  void FactorFrontTogether(int f, const double* values, int thread);
  void AssemblePanel(int f, const double* values, const Panel& panel, int column_begin,
                     int column_end);
  void AddChildren(int f, const Panel& panel, int column_begin, int column_end);
  bool FactorPass(const Panel& panel, int begin, int end, double* inverse);
  void Store(int f, const Panel& panel, int tile_begin, int tile_end);
  void SolveColumns(Eigen::Ref<Eigen::MatrixXd> columns, bool rounded);
  void SubstituteForward(int f, int width, bool rounded);
  void SubstituteBackward(int f, int width, int thread, bool rounded);

  internal::FrontTree tree_;
  internal::FrontSchedule schedule_;
  internal::SubstitutionPlan plan_;
  const dense::FrontKernels& kernels_;
  ThreadTeam& team_;
  InstructionSet instruction_set_;
  int size_;
  size_t block_entries_;
  std::vector<size_t> factor_offset_;  ///< [fronts]
  internal::AlignedBuffer factor_;
  internal::AlignedBufferOf<float> rounded_;  ///< the same numbers; empty where nobody wants them
  /// Room for the front that is worked on: small enough to stay in the cache, which the whole
  /// factor is not.
  std::vector<internal::AlignedBuffer> panels_;  ///< [threads]
  internal::AlignedBuffer shared_panel_;
  internal::AlignedBuffer updates_;
  std::vector<double> inverse_;  ///< [Size()] reciprocals of the factor's diagonal
  std::atomic<bool> positive_{false};
  bool has_factor_ = false;
  bool has_rounded_ = false;

  /// Right-hand sides, row after row: those of the matrix, then each thread's share.
  internal::AlignedBuffer rows_;
  std::vector<internal::AlignedBuffer> below_;  ///< [threads] a single column's rows below a front
};

/// Columns of the panel: what the matrix and the children have in them.
void MultifrontalSolver::AssemblePanel(int f, const double* values, const Panel& panel,
                                       int column_begin, int column_end) {
  kernels_.clear(panel, column_begin, column_end);
  for (const internal::PanelBlock& block : tree_.blocks()[At(f)]) {
    if (block.offset < column_begin * panel.stride || block.offset >= column_end * panel.stride) {
      continue;
    }
    const double* source = values + At(kBlockEntries) * At(block.block);
    double* target = panel.values + block.offset;
    for (int c = 0; c < 3; ++c) {
      for (int r = 0; r < 3; ++r) target[c * panel.stride + r] = source[3 * c + r];
    }
  }
  AddChildren(f, panel, column_begin, column_end);
}

void MultifrontalSolver::AddChildren(int f, const Panel& panel, int column_begin, int column_end) {
  for (const int child : FrontOf(f).children) {
    const std::vector<dense::Run>& runs = FrontOf(child).runs;
    kernels_.extend_add(UpdateOf(child), runs.data(), static_cast<int>(runs.size()), panel,
                        UpdateOf(f), column_begin, column_end);
  }
}

/// Eliminates the columns [begin, end) of the panel, those before being known.
bool MultifrontalSolver::FactorPass(const Panel& panel, int begin, int end, double* inverse) {
  alignas(64) double tile[kTile * kTile];
  for (int first = begin; first < end; first += kTile) {
    const int width = std::min(kTile, end - first);
    if (!kernels_.factor_tile(panel, begin, first, width, tile, inverse + first)) return false;
    kernels_.eliminate_rows(panel, begin, first, width, tile, inverse + first, first + kTile,
                            panel.Rows());
    for (int c = 0; c < width; ++c) {
      std::copy_n(tile + c * kTile, kTile, panel.values + (first + c) * panel.stride + first);
    }
  }
  return true;
}

void MultifrontalSolver::FactorFront(int f, const double* values, internal::AlignedBuffer& room) {
  if (!positive_.load(std::memory_order_relaxed)) return;
  const Panel panel = PanelOf(f, room);
  double* inverse = inverse_.data() + 3 * FrontOf(f).first_node;
  AssemblePanel(f, values, panel, 0, panel.pivots);
  for (int begin = 0; begin < panel.pivots; begin += kPassColumns) {
    const int end = std::min(begin + kPassColumns, panel.pivots);
    if (!FactorPass(panel, begin, end, inverse)) {
      positive_.store(false, std::memory_order_relaxed);
      return;
    }
    kernels_.update_pivots(panel, begin, end, end, panel.pivots, end, panel.Rows());
  }
  kernels_.update_below(panel, UpdateOf(f), 0, dense::PaddedRows(panel.below));
  AddChildren(f, panel, panel.PivotRows(), panel.Rows());
  Store(f, panel, 0, panel.Rows() / kTile);
}

void MultifrontalSolver::Store(int f, const Panel& panel, int tile_begin, int tile_end) {
  kernels_.store(panel, FactorOf(f), tile_begin, tile_end);
  if (rounded_.size() > 0) kernels_.store_rounded(panel, RoundedOf(f), tile_begin, tile_end);
}

/// The same steps in the same order on each entry, the rows shared among the threads.
void MultifrontalSolver::FactorFrontTogether(int f, const double* values, int thread) {
  const Panel panel = PanelOf(f, shared_panel_);
  const int threads = team_.Size();
  const int rows = panel.Rows();
  double* inverse = inverse_.data() + 3 * FrontOf(f).first_node;
  // Whole nodes stay together.
  const auto part = [&](int columns, int k) { return columns / 3 * k / threads * 3; };
  AssemblePanel(f, values, panel, part(panel.pivots, thread), part(panel.pivots, thread + 1));
  team_.Barrier();
  alignas(64) double tile[kTile * kTile];
  double tile_inverse[kTile];
  for (int begin = 0; begin < panel.pivots; begin += kPassColumns) {
    const int end = std::min(begin + kPassColumns, panel.pivots);
    for (int first = begin; first < end; first += kTile) {
      const int width = std::min(kTile, end - first);
      // Every thread takes the tile's factor for itself: cheaper than to wait for another.
      if (!kernels_.factor_tile(panel, begin, first, width, tile, tile_inverse)) {
        positive_.store(false, std::memory_order_relaxed);
      }
      const int tiles = (rows - first) / kTile - 1;
      kernels_.eliminate_rows(panel, begin, first, width, tile, tile_inverse,
                              first + kTile + kTile * (tiles * thread / threads),
                              first + kTile + kTile * (tiles * (thread + 1) / threads));
      team_.Barrier();
      if (thread != 0) continue;
      std::copy_n(tile_inverse, width, inverse + first);
      for (int c = 0; c < width; ++c) {
        std::copy_n(tile + c * kTile, kTile, panel.values + (first + c) * panel.stride + first);
      }
    }
    for (int row = end + kSharedRows * thread; row < rows; row += kSharedRows * threads) {
      kernels_.update_pivots(panel, begin, end, end, panel.pivots, row,
                             std::min(row + kSharedRows, rows));
    }
    team_.Barrier();
  }
  const int update_rows = dense::PaddedRows(panel.below);
  for (int row = kSharedRows * thread; row < update_rows; row += kSharedRows * threads) {
    kernels_.update_below(panel, UpdateOf(f), row, std::min(row + kSharedRows, update_rows));
  }
  const int tiles = rows / kTile;
  Store(f, panel, tiles * thread / threads, tiles * (thread + 1) / threads);
  team_.Barrier();
  AddChildren(f, panel, panel.PivotRows() + part(panel.below, thread),
              panel.PivotRows() + part(panel.below, thread + 1));
  team_.Barrier();
}

void MultifrontalSolver::SubstituteForward(int f, int width, bool rounded) {
  const int first = 3 * FrontOf(f).first_node;
  if (rounded) {
    kernels_.solve_forward_rounded(RoundedOf(f), inverse_.data() + first, rows_.data() + first,
                                   plan_.forward_rows[At(f)].data(), rows_.data());
    return;
  }
  if (width == 1) {
    kernels_.solve_forward_one(FactorOf(f), inverse_.data() + first, rows_.data() + first,
                               plan_.forward_rows[At(f)].data(), rows_.data());
    return;
  }
  kernels_.solve_forward(FactorOf(f), inverse_.data() + first, width,
                         rows_.data() + static_cast<long>(first) * width,
                         plan_.forward_rows[At(f)].data(), rows_.data());
}

void MultifrontalSolver::SubstituteBackward(int f, int width, int thread, bool rounded) {
  const int first = 3 * FrontOf(f).first_node;
  if (rounded) {
    kernels_.solve_backward_rounded(RoundedOf(f), inverse_.data() + first, rows_.data() + first,
                                    FrontOf(f).below_rows.data(), rows_.data(),
                                    below_[At(thread)].data());
    return;
  }
  if (width == 1) {
    kernels_.solve_backward_one(FactorOf(f), inverse_.data() + first, rows_.data() + first,
                                FrontOf(f).below_rows.data(), rows_.data(),
                                below_[At(thread)].data());
    return;
  }
  kernels_.solve_backward(FactorOf(f), inverse_.data() + first, width,
                          rows_.data() + static_cast<long>(first) * width,
                          FrontOf(f).below_rows.data(), rows_.data());
}

/// At most 2 kTile columns; `rounded`: one, by the rounded factor.
void MultifrontalSolver::SolveColumns(Eigen::Ref<Eigen::MatrixXd> columns, bool rounded) {
  const int count = static_cast<int>(columns.cols());
  const int width = count == 1 ? 1 : count <= kTile ? kTile : 2 * kTile;
  const auto& tree_order = tree_.fronts();
  team_.Run([&](int thread) {
    const std::vector<int>& own = schedule_.own[At(thread)];
    const auto shares = static_cast<long>(plan_.shared_rows.size());
    const auto read = [&](int f) {
      const Front& front = tree_order[At(f)];
      for (int row = 3 * front.first_node; row < 3 * front.first_node + front.Pivots(); ++row) {
        double* target = rows_.data() + static_cast<long>(row) * width;
        for (int c = 0; c < count; ++c) target[c] = columns(row, c);
        std::fill(target + count, target + width, 0.0);
      }
    };
    const auto write = [&](int f) {
      const Front& front = tree_order[At(f)];
      for (int row = 3 * front.first_node; row < 3 * front.first_node + front.Pivots(); ++row) {
        const double* source = rows_.data() + static_cast<long>(row) * width;
        for (int c = 0; c < count; ++c) columns(row, c) = source[c];
      }
    };
    double* share = rows_.data() + (size_ + thread * shares) * width;
    std::fill_n(share, shares * width, 0.0);
    for (const int f : own) read(f);
    if (thread == 0) {
      for (const int f : schedule_.together) read(f);
    }
    for (const int f : own) SubstituteForward(f, width, rounded);
    team_.Barrier();
    if (thread == 0) {
      for (long k = 0; k < shares; ++k) {
        double* target =
            rows_.data() + static_cast<long>(plan_.shared_rows[static_cast<size_t>(k)]) * width;
        for (int t = 0; t < team_.Size(); ++t) {
          const double* source = rows_.data() + (size_ + t * shares + k) * width;
          for (int c = 0; c < width; ++c) target[c] += source[c];
        }
      }
      for (const int f : schedule_.together) SubstituteForward(f, width, rounded);
      for (auto f = schedule_.together.rbegin(); f != schedule_.together.rend(); ++f) {
        SubstituteBackward(*f, width, thread, rounded);
        write(*f);
      }
    }
    team_.Barrier();
    for (auto f = own.rbegin(); f != own.rend(); ++f) {
      SubstituteBackward(*f, width, thread, rounded);
      write(*f);
    }
  });
}

}  // namespace

std::unique_ptr<SparseSolver> MakeMultifrontalSolver(const BlockPattern& pattern, ThreadTeam& team,
                                                     InstructionSet instruction_set) {
  return std::make_unique<MultifrontalSolver>(pattern, team, instruction_set);
}

}  // namespace palpate::fem
