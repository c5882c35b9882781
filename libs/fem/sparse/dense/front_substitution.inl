// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

/// Forward and backward substitution with one front; included by front_kernels.inl, on whose packs
/// and tiles it stands.
namespace {

template <int packs>
PALPATE_INLINE void LoadRow(const double* source, Pack (&row)[packs]) {
  for (int i = 0; i < packs; ++i) row[i] = Load(source + i * kLanes);
}

template <int packs>
PALPATE_INLINE void StoreRow(double* target, const Pack (&row)[packs]) {
  for (int i = 0; i < packs; ++i) Store(target + i * kLanes, row[i]);
}

/// A column of a tile in double precision; `room` is used where it is stored in less.
PALPATE_INLINE const double* Widened(const double* column, double (&)[kTile]) { return column; }
PALPATE_INLINE const double* Widened(const float* column, double (&room)[kTile]) {
  for (int i = 0; i < kTilePacks; ++i) Store(room + i * kLanes, Load(column + i * kLanes));
  return room;
}

/// sum[r] -= L[r] y over `count` columns of a tile, y being rows of right-hand sides.
template <int packs, int from = 0, typename Value>
PALPATE_INLINE void SubtractRows(const Value* tile, int count, const double* y,
                                 Pack (&sum)[kTile][packs]) {
  constexpr int to = std::min(kTile, from + Group(packs));
  for (int p = 0; p < count; ++p) {
    alignas(64) double room[kTile];
    const double* column = Widened(tile + p * kTile, room);
    Pack known[packs];
    LoadRow(y + p * packs * kLanes, known);
    for (int r = from; r < to; ++r) {
      for (int i = 0; i < packs; ++i) sum[r][i] -= known[i] * column[r];
    }
  }
  if constexpr (to < kTile) SubtractRows<packs, to>(tile, count, y, sum);
}

/// A tile with fewer than kTile pivots is computed whole, so that all stays in registers: what lies
/// behind its rows is some other number, which goes nowhere.
template <int packs, typename Value>
void SolveForward(const FactorPanelOf<Value>& factor, const double* inverse, double* pivot_rows,
                  const int* below_rows, double* all_rows) {
  constexpr int width = packs * kLanes;
  const Value* tile = factor.values;
  for (int first = 0; first < factor.pivots; first += kTile) {
    const int rows = std::min(kTile, factor.pivots - first);
    Pack sum[kTile][packs] = {};
    Unroll<0, kTile>([&](auto r) __attribute__((always_inline)) {
      if (r < rows) LoadRow(pivot_rows + (first + r) * width, sum[r]);
    });
    SubtractRows<packs>(tile, first, pivot_rows, sum);
    tile += first * kTile;
    Unroll<0, kTile>([&](auto r) __attribute__((always_inline)) {
      for (int i = 0; i < packs; ++i) sum[r][i] *= inverse[first + r];
      Unroll<r + 1, kTile>([&](auto s) __attribute__((always_inline)) {
        for (int i = 0; i < packs; ++i) sum[s][i] -= sum[r][i] * tile[r * kTile + s];
      });
      if (r < rows) StoreRow(pivot_rows + (first + r) * width, sum[r]);
    });
    tile += rows * kTile;
  }
  for (int first = 0; first < factor.below; first += kTile) {
    const int rows = std::min(kTile, factor.below - first);
    Pack sum[kTile][packs] = {};
    SubtractRows<packs>(tile, factor.pivots, pivot_rows, sum);
    tile += factor.pivots * kTile;
    Unroll<0, kTile>([&](auto r) __attribute__((always_inline)) {
      if (r >= rows) return;
      double* target = all_rows + static_cast<long>(below_rows[first + r]) * width;
      for (int i = 0; i < packs; ++i) {
        Store(target + i * kLanes, Load(target + i * kLanes) + sum[r][i]);
      }
    });
  }
}

/// y[p] -= L[., p]' known over the columns [0, count) of a tile.
template <int packs, int from = 0, typename Value>
PALPATE_INLINE void SubtractTransposed(const Value* tile, int count,
                                       const Pack (&known)[kTile][packs], double* y) {
  constexpr int to = std::min(kTile, from + Group(packs));
  for (int p = 0; p < count; ++p) {
    alignas(64) double room[kTile];
    const double* column = Widened(tile + p * kTile, room);
    Pack sum[packs];
    LoadRow(y + p * packs * kLanes, sum);
    for (int r = from; r < to; ++r) {
      for (int i = 0; i < packs; ++i) sum[i] -= known[r][i] * column[r];
    }
    StoreRow(y + p * packs * kLanes, sum);
  }
  if constexpr (to < kTile) SubtractTransposed<packs, to>(tile, count, known, y);
}

template <int packs, typename Value>
void SolveBackward(const FactorPanelOf<Value>& factor, const double* inverse, double* pivot_rows,
                   const int* below_rows, const double* all_rows) {
  constexpr int width = packs * kLanes;
  const Value* tile = factor.values + FactorPanelOf<Value>::Size(factor.pivots, 0);
  for (int first = 0; first < factor.below; first += kTile) {
    const int rows = std::min(kTile, factor.below - first);
    Pack known[kTile][packs] = {};
    Unroll<0, kTile>([&](auto r) __attribute__((always_inline)) {
      if (r < rows) {
        LoadRow(all_rows + static_cast<long>(below_rows[first + r]) * width, known[r]);
      }
    });
    SubtractTransposed<packs>(tile, factor.pivots, known, pivot_rows);
    tile += factor.pivots * kTile;
  }
  tile = factor.values + FactorPanelOf<Value>::Size(factor.pivots, 0);
  for (int first = (factor.pivots - 1) / kTile * kTile; first >= 0; first -= kTile) {
    const int rows = std::min(kTile, factor.pivots - first);
    tile -= TileColumns(first, factor.pivots) * kTile;
    const Value* diagonal = tile + first * kTile;
    Pack sum[kTile][packs] = {};
    Unroll<0, kTile>([&](auto r) __attribute__((always_inline)) {
      if (r < rows) LoadRow(pivot_rows + (first + r) * width, sum[r]);
    });
    Unroll<0, kTile>([&](auto k) __attribute__((always_inline)) {
      constexpr int c = kTile - 1 - k;
      if (c >= rows) return;
      for (int i = 0; i < packs; ++i) sum[c][i] *= inverse[first + c];
      StoreRow(pivot_rows + (first + c) * width, sum[c]);
      Unroll<0, c>([&](auto r) __attribute__((always_inline)) {
        for (int i = 0; i < packs; ++i) sum[r][i] -= sum[c][i] * diagonal[r * kTile + c];
      });
    });
    SubtractTransposed<packs>(tile, first, sum, pivot_rows);
  }
}

template <typename Value>
void SolveForwardAny(const FactorPanelOf<Value>& factor, const double* inverse, int width,
                     double* pivot_rows, const int* below_rows, double* all_rows) {
  if (width == kTile) {
    SolveForward<kTilePacks>(factor, inverse, pivot_rows, below_rows, all_rows);
  } else {
    SolveForward<2 * kTilePacks>(factor, inverse, pivot_rows, below_rows, all_rows);
  }
}

template <typename Value>
void SolveBackwardAny(const FactorPanelOf<Value>& factor, const double* inverse, int width,
                      double* pivot_rows, const int* below_rows, const double* all_rows) {
  if (width == kTile) {
    SolveBackward<kTilePacks>(factor, inverse, pivot_rows, below_rows, all_rows);
  } else {
    SolveBackward<2 * kTilePacks>(factor, inverse, pivot_rows, below_rows, all_rows);
  }
}

}  // namespace
