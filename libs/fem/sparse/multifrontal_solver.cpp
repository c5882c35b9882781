// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <atomic>
#include <cmath>
#include <vector>

#include "libs/core/check.hpp"
#include "libs/core/index.hpp"
#include "libs/fem/sparse/aligned_buffer.hpp"
#include "libs/fem/sparse/dense/front_kernels.hpp"
#include "libs/fem/sparse/factor_store.hpp"
#include "libs/fem/sparse/front_schedule.hpp"
#include "libs/fem/sparse/front_tree.hpp"
#include "libs/fem/sparse/sparse_solver.hpp"
#include "libs/fem/sparse/substitution.hpp"

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

class MultifrontalSolver final : public SparseSolver {
 public:
  MultifrontalSolver(const BlockPattern& pattern, ThreadTeam& team, InstructionSet instruction_set)
      : tree_(pattern),
        schedule_(internal::ScheduleFronts(tree_, team.Size())),
        kernels_(dense::SelectFrontKernels(instruction_set)),
        team_(team),
        instruction_set_(instruction_set),
        factor_(tree_, pattern.Size()),
        substitution_(tree_, schedule_, kernels_, team, factor_, pattern.Size()),
        size_{pattern.Size()},
        block_entries_{kBlockEntries * pattern.row.size()} {
    for (const std::vector<int>& own : schedule_.own) panels_.push_back(RoomForPanels(own));
    shared_panel_ = RoomForPanels(schedule_.together);
    updates_ = internal::AlignedBuffer(schedule_.update_size);
  }

  Status Factorize(std::span<const double> values) override {
    PALPATE_CHECK(values.size() == block_entries_, values.size(), block_entries_);
    has_factor_ = false;
    positive_.store(true, std::memory_order_relaxed);
    team_.Run([&](int thread) {
      for (const int f : schedule_.own[At(thread)])
        FactorFront(f, values.data(), panels_[At(thread)]);
    });
    for (const int f : schedule_.together) FactorFrontTogether(f, values.data());
    has_factor_ = positive_.load(std::memory_order_relaxed);
    has_single_ = has_factor_ && factor_.has_room_for_single();
    if (has_factor_) return Status::Ok();
    const bool finite =
        std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
    return finite ? Status(StatusCode::kNotPositiveDefinite, {})
                  : Status(StatusCode::kInvalidInput, "the matrix is not finite");
  }

  void Solve(Eigen::Ref<Eigen::MatrixXd> columns) override {
    PALPATE_CHECK(has_factor_);
    PALPATE_CHECK(columns.rows() == size_, columns.rows(), size_);
    substitution_.Solve(columns, false);
  }

  void KeepSinglePrecision() override {
    if (factor_.has_room_for_single()) return;
    factor_.MakeRoomForSingle();
    has_single_ = false;
  }

  void SolveSingle(Eigen::Ref<Eigen::MatrixXd> columns) override {
    PALPATE_CHECK(has_factor_);
    PALPATE_CHECK(columns.rows() == size_, columns.rows(), size_);
    substitution_.Solve(columns, has_single_);
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
    size_t bytes =
        factor_.Bytes() + substitution_.Bytes() + updates_.bytes() + shared_panel_.bytes();
    for (const internal::AlignedBuffer& panel : panels_) bytes += panel.bytes();
    return bytes;
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
  Update UpdateOf(int f) {
    return {updates_.data() + schedule_.update_offset[At(f)], FrontOf(f).UpdateStride()};
  }

  void FactorFront(int f, const double* values, internal::AlignedBuffer& room);
  void FactorFrontTogether(int f, const double* values);
  void FactorPassTogether(const Panel& panel, int begin, int end, double* inverse);
  void AssemblePanel(int f, const double* values, const Panel& panel, int column_begin,
                     int column_end);
  void AddChildren(int f, const Panel& panel, int column_begin, int column_end);
  bool FactorPass(const Panel& panel, int begin, int end, double* inverse);
  void Store(int f, const Panel& panel, int tile_begin, int tile_end);

  internal::FrontTree tree_;
  internal::FrontSchedule schedule_;
  const dense::FrontKernels& kernels_;
  ThreadTeam& team_;
  InstructionSet instruction_set_;
  internal::FactorStore factor_;
  internal::Substitution substitution_;
  int size_;
  size_t block_entries_;
  /// Room for the front that is worked on: small enough to stay in the cache, which the whole
  /// factor is not.
  std::vector<internal::AlignedBuffer> panels_;  ///< [threads]
  internal::AlignedBuffer shared_panel_;
  internal::AlignedBuffer updates_;
  std::atomic<bool> positive_{false};
  bool has_factor_ = false;
  bool has_single_ = false;
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
  double* inverse = factor_.inverse() + 3 * FrontOf(f).first_node;
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
  kernels_.store(panel, factor_.Panel(f), tile_begin, tile_end);
  if (factor_.has_room_for_single()) {
    kernels_.store_single(panel, factor_.Rounded(f), tile_begin, tile_end);
  }
}

/// The same steps in the same order on each entry, the rows shared among the threads.
void MultifrontalSolver::FactorFrontTogether(int f, const double* values) {
  const Panel panel = PanelOf(f, shared_panel_);
  const int threads = team_.Size();
  double* inverse = factor_.inverse() + 3 * FrontOf(f).first_node;
  // Whole nodes stay together.
  const auto part = [&](int columns, int k) { return columns / 3 * k / threads * 3; };
  team_.Run([&](int thread) {
    AssemblePanel(f, values, panel, part(panel.pivots, thread), part(panel.pivots, thread + 1));
  });
  for (int begin = 0; begin < panel.pivots; begin += kPassColumns) {
    FactorPassTogether(panel, begin, std::min(begin + kPassColumns, panel.pivots), inverse);
  }
  const int update_rows = dense::PaddedRows(panel.below);
  const int tiles = panel.Rows() / kTile;
  team_.Run([&](int thread) {
    for (int row = kSharedRows * thread; row < update_rows; row += kSharedRows * threads) {
      kernels_.update_below(panel, UpdateOf(f), row, std::min(row + kSharedRows, update_rows));
    }
    Store(f, panel, tiles * thread / threads, tiles * (thread + 1) / threads);
  });
  team_.Run([&](int thread) {
    AddChildren(f, panel, panel.PivotRows() + part(panel.below, thread),
                panel.PivotRows() + part(panel.below, thread + 1));
  });
}

void MultifrontalSolver::FactorPassTogether(const Panel& panel, int begin, int end,
                                            double* inverse) {
  const int threads = team_.Size();
  const int rows = panel.Rows();
  for (int first = begin; first < end; first += kTile) {
    const int width = std::min(kTile, end - first);
    const int tiles = (rows - first) / kTile - 1;
    alignas(64) double tile_of_caller[kTile * kTile];
    double inverse_of_caller[kTile];
    team_.Run([&](int thread) {
      // Every thread takes the tile's factor for itself: cheaper than to wait for another.
      alignas(64) double own_tile[kTile * kTile];
      double own_inverse[kTile];
      double* tile = thread == 0 ? tile_of_caller : own_tile;
      double* tile_inverse = thread == 0 ? inverse_of_caller : own_inverse;
      if (!kernels_.factor_tile(panel, begin, first, width, tile, tile_inverse)) {
        positive_.store(false, std::memory_order_relaxed);
      }
      kernels_.eliminate_rows(panel, begin, first, width, tile, tile_inverse,
                              first + kTile + kTile * (tiles * thread / threads),
                              first + kTile + kTile * (tiles * (thread + 1) / threads));
    });
    std::copy_n(inverse_of_caller, width, inverse + first);
    for (int c = 0; c < width; ++c) {
      std::copy_n(tile_of_caller + c * kTile, kTile,
                  panel.values + (first + c) * panel.stride + first);
    }
  }
  team_.Run([&](int thread) {
    for (int row = end + kSharedRows * thread; row < rows; row += kSharedRows * threads) {
      kernels_.update_pivots(panel, begin, end, end, panel.pivots, row,
                             std::min(row + kSharedRows, rows));
    }
  });
}

}  // namespace

std::unique_ptr<SparseSolver> MakeMultifrontalSolver(const BlockPattern& pattern, ThreadTeam& team,
                                                     InstructionSet instruction_set) {
  return std::make_unique<MultifrontalSolver>(pattern, team, instruction_set);
}

}  // namespace palpate::fem
