// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

/// Substitution of a single right-hand side, where the rows of a tile fill the register that the
/// columns fill elsewhere; included by front_kernels.inl.
namespace {

typedef double LoosePack __attribute__((vector_size(8 * kLanes), aligned(8), may_alias));

/// `count` <= kTile numbers that may lie anywhere, and zeros behind them.
PALPATE_INLINE void LoadRows(const double* source, int count, Pack (&rows)[kTilePacks]) {
  if (count == kTile) {
    for (int i = 0; i < kTilePacks; ++i) {
      rows[i] = *reinterpret_cast<const LoosePack*>(source + i * kLanes);
    }
    return;
  }
  alignas(64) double filled_up[kTile] = {};
  for (int r = 0; r < count; ++r) filled_up[r] = source[r];
  for (int i = 0; i < kTilePacks; ++i) rows[i] = Load(filled_up + i * kLanes);
}

/// sum -= L y over `count` columns of a tile, in chains that do not wait for one another.
template <typename Value>
PALPATE_INLINE void SubtractColumn(const Value* tile, int count, const double* y,
                                   Pack (&sum)[kTilePacks]) {
  constexpr int kChains = 4;
  Pack chain[kChains][kTilePacks] = {};
  int p = 0;
  for (; p + kChains <= count; p += kChains) {
    for (int k = 0; k < kChains; ++k) {
      for (int i = 0; i < kTilePacks; ++i) {
        chain[k][i] += Load(tile + (p + k) * kTile + i * kLanes) * y[p + k];
      }
    }
  }
  for (; p < count; ++p) {
    for (int i = 0; i < kTilePacks; ++i) chain[0][i] += Load(tile + p * kTile + i * kLanes) * y[p];
  }
  for (int i = 0; i < kTilePacks; ++i) {
    sum[i] -= (chain[0][i] + chain[1][i]) + (chain[2][i] + chain[3][i]);
  }
}

template <typename Value>
void SolveForwardOne(const FactorPanelOf<Value>& factor, const double* inverse, double* pivot_rows,
                     const int* below_rows, double* all_rows) {
  const Value* tile = factor.values;
  for (int first = 0; first < factor.pivots; first += kTile) {
    const int rows = std::min(kTile, factor.pivots - first);
    Pack sum[kTilePacks];
    LoadRows(pivot_rows + first, rows, sum);
    SubtractColumn(tile, first, pivot_rows, sum);
    tile += first * kTile;
    Unroll<0, kTile>([&](auto r) __attribute__((always_inline)) {
      if (r >= rows) return;
      const double solved = sum[r / kLanes][r % kLanes] * inverse[first + r];
      pivot_rows[first + r] = solved;
      for (int i = 0; i < kTilePacks; ++i) sum[i] -= Load(tile + r * kTile + i * kLanes) * solved;
    });
    tile += rows * kTile;
  }
  for (int first = 0; first < factor.below; first += kTile) {
    const int rows = std::min(kTile, factor.below - first);
    Pack sum[kTilePacks] = {};
    SubtractColumn(tile, factor.pivots, pivot_rows, sum);
    tile += factor.pivots * kTile;
    Unroll<0, kTile>([&](auto r) __attribute__((always_inline)) {
      if (r < rows) all_rows[below_rows[first + r]] += sum[r / kLanes][r % kLanes];
    });
  }
}

/// Columns of a tile whose products with the rows below are summed at a time.
constexpr int kColumnGroup = kTilePacks == 1 ? kTile : kTile / 2;
using ColumnSums = Pack[kColumnGroup][kTilePacks];

/// sum[c] += L[., c] known, lane by lane.
template <typename Value>
PALPATE_INLINE void AddProducts(const Value* tile, const Pack (&known)[kTilePacks],
                                ColumnSums& sum) {
  for (int c = 0; c < kColumnGroup; ++c) {
    for (int i = 0; i < kTilePacks; ++i)
      sum[c][i] += Load(tile + c * kTile + i * kLanes) * known[i];
  }
}

/// total[c] = sum of sum[c]'s lanes.
PALPATE_INLINE void AddLanesUp(const ColumnSums& sum, double* total) {
  for (int c = 0; c < kColumnGroup; ++c) {
    Pack lanes = sum[c][0];
    for (int i = 1; i < kTilePacks; ++i) lanes += sum[c][i];
    total[c] = 0.0;
    for (int lane = 0; lane < kLanes; ++lane) total[c] += lanes[lane];
  }
}

/// What the rows behind the tile of columns that starts at `first`, already solved, have in it. A
/// tile with fewer columns is computed whole: what lies behind them is some other number, which
/// goes nowhere.
template <typename Value>
void MultiplyTransposed(const FactorPanelOf<Value>& factor, int first, const double* pivot_rows,
                        const double* below, double* total) {
  using Factor = FactorPanelOf<Value>;
  const Value* below_tiles = factor.values + Factor::Size(factor.pivots, 0);
  for (int column = first; column < first + kTile; column += kColumnGroup) {
    ColumnSums sum = {};
    Pack known[kTilePacks];
    for (int row = first + kTile; row < factor.pivots; row += kTile) {
      LoadRows(pivot_rows + row, std::min(kTile, factor.pivots - row), known);
      AddProducts(factor.values + Factor::Size(row, 0) + column * kTile, known, sum);
    }
    const Value* tile = below_tiles + column * kTile;
    for (int row = 0; row < factor.below; row += kTile, tile += factor.pivots * kTile) {
      for (int i = 0; i < kTilePacks; ++i) known[i] = Load(below + row + i * kLanes);
      AddProducts(tile, known, sum);
    }
    AddLanesUp(sum, total + (column - first));
  }
}

template <typename Value>
void SolveBackwardOne(const FactorPanelOf<Value>& factor, const double* inverse, double* pivot_rows,
                      const int* below_rows, const double* all_rows, double* below) {
  for (int r = 0; r < factor.below; ++r) below[r] = all_rows[below_rows[r]];
  for (int r = factor.below; r % kTile != 0; ++r) below[r] = 0.0;
  for (int first = (factor.pivots - 1) / kTile * kTile; first >= 0; first -= kTile) {
    const int columns = std::min(kTile, factor.pivots - first);
    double y[kTile];
    MultiplyTransposed(factor, first, pivot_rows, below, y);
    const Value* diagonal = factor.values + FactorPanelOf<Value>::Size(first, 0) + first * kTile;
    for (int c = 0; c < columns; ++c) y[c] = pivot_rows[first + c] - y[c];
    for (int c = columns - 1; c >= 0; --c) {
      y[c] *= inverse[first + c];
      pivot_rows[first + c] = y[c];
      for (int b = 0; b < c; ++b) y[b] -= double{diagonal[b * kTile + c]} * y[c];
    }
  }
}

}  // namespace
