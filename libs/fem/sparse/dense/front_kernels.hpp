// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstddef>

#include "libs/core/instruction_set.hpp"

namespace palpate::fem::dense {

/// Rows of a tile: one pack. Row counts of panels are padded to multiples of it.
inline constexpr int kTile = 8;
constexpr int PaddedRows(int rows) { return (rows + kTile - 1) / kTile * kTile; }

/// The pivot columns of a front while it is worked on, column after column at a distance of
/// `stride`: `pivots` rows, padded with zeros to PaddedRows(pivots), then `below` rows, padded
/// likewise. Above the diagonal there may be anything. 64-byte aligned, as is each column.
struct Panel {
  double* values = nullptr;
  long stride = 0;
  int pivots = 0;
  int below = 0;

  int PivotRows() const { return PaddedRows(pivots); }
  int Rows() const { return PivotRows() + PaddedRows(below); }
};

/// The pivot columns of a factorised front as substitution reads them, from the first to the last
/// or back: tiles of kTile rows; in each, column after column, the columns up to its diagonal.
template <typename Value>
struct FactorPanelOf {
  Value* values = nullptr;
  int pivots = 0;
  int below = 0;

  static size_t Size(int pivots, int below) {
    const auto whole = static_cast<size_t>(pivots / kTile);
    const auto columns = static_cast<size_t>(pivots);
    const size_t triangle = kTile * whole * (whole + 1) / 2 + (pivots % kTile != 0 ? columns : 0);
    return kTile * (triangle + columns * static_cast<size_t>(PaddedRows(below) / kTile));
  }
};

using FactorPanel = FactorPanelOf<double>;
using SinglePrecisionPanel = FactorPanelOf<float>;

/// The contribution of a front to its parent, below x below, lower triangle; above the diagonal
/// there may be anything.
struct Update {
  double* values = nullptr;
  long stride = 0;
};

/// Rows of an update that follow one another in the parent's front, too.
struct Run {
  int source = 0;  ///< first row in the update
  int target = 0;  ///< first row in the parent's panel; from PivotRows() on in its update
  int length = 0;
};

/// Substitution by a factor, in double precision. By a rounded one half the memory is read, which
/// is what the time of few columns goes with.
template <typename Value>
struct SubstitutionKernelsOf {
  using Factor = FactorPanelOf<Value>;

  /// Forward substitution: overwrites `pivot_rows` [pivots][width] and subtracts from row
  /// `below_rows[i]` of `all_rows` [..][width], for each row i below the pivots. width is kTile or
  /// 2 kTile columns of right-hand sides, stored row after row.
  void (*solve_forward)(const Factor& factor, const double* inverse, int width, double* pivot_rows,
                        const int* below_rows, double* all_rows);
  /// Backward substitution: overwrites `pivot_rows` with what the rows below, already solved, and
  /// the factor's transpose make of them.
  void (*solve_backward)(const Factor& factor, const double* inverse, int width, double* pivot_rows,
                         const int* below_rows, const double* all_rows);
  /// The same for a single right-hand side.
  void (*solve_forward_one)(const Factor& factor, const double* inverse, double* pivot_rows,
                            const int* below_rows, double* all_rows);
  /// `sums` [pivots][kTile] is room to work in, aligned like a panel.
  void (*solve_backward_one)(const Factor& factor, const double* inverse, double* pivot_rows,
                             const int* below_rows, const double* all_rows, double* sums);
};

/// Dense steps of a multifrontal Cholesky factorisation, compiled for each instruction set. Rows
/// and columns are counted from the panel's first; ranges are half open and start at multiples of
/// kTile, so that threads can share a front.
struct FrontKernels {
  /// Zeroes the columns [column_begin, column_end) of a panel.
  void (*clear)(const Panel& panel, int column_begin, int column_end);
  /// Adds a child's update, whose rows lie as `runs` say, to the columns [column_begin, column_end)
  /// of its parent's front, counted like Run::target; the range cuts no node.
  void (*extend_add)(const Update& child, const Run* runs, int run_count, const Panel& panel,
                     const Update& update, int column_begin, int column_end);
  /// Columns [first, first + width), width <= kTile, of the panel: subtracts the products of the
  /// columns [begin, first), then takes the Cholesky factor of the tile on the diagonal into
  /// `tile` [kTile columns of kTile] and the reciprocals of its pivots into `inverse` [width].
  /// False, where a pivot is not a positive finite number.
  bool (*factor_tile)(const Panel& panel, int begin, int first, int width, double* tile,
                      double* inverse);
  /// The same columns in the rows [row_begin, row_end) below the tile, once that is known.
  void (*eliminate_rows)(const Panel& panel, int begin, int first, int width, const double* tile,
                         const double* inverse, int row_begin, int row_end);
  /// Columns [column_begin, column_end) of the panel, rows [row_begin, row_end) on and below the
  /// diagonal: subtracts the products of the columns [begin, end).
  void (*update_pivots)(const Panel& panel, int begin, int end, int column_begin, int column_end,
                        int row_begin, int row_end);
  /// update = -below below' of the panel's rows below the pivots, in the update's rows
  /// [row_begin, row_end).
  void (*update_below)(const Panel& panel, const Update& update, int row_begin, int row_end);

  /// Stores the tiles of rows [tile_begin, tile_end) of a panel that is done.
  void (*store)(const Panel& panel, const FactorPanel& factor, int tile_begin, int tile_end);
  void (*store_single)(const Panel& panel, const SinglePrecisionPanel& factor, int tile_begin,
                       int tile_end);

  SubstitutionKernelsOf<double> exact;
  SubstitutionKernelsOf<float> rounded;
};

const FrontKernels& SelectFrontKernels(InstructionSet set);

}  // namespace palpate::fem::dense
