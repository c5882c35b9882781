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

/// sums[p] += L[., p] known, lane by lane, over the columns [0, count) of a tile: the factor is
/// read as it lies in memory, and the sums stay in the nearest cache.
template <typename Value>
PALPATE_INLINE void AddProducts(const Value* tile, int count, const Pack (&known)[kTilePacks],
                                double* sums) {
  for (int p = 0; p < count; ++p) {
    for (int i = 0; i < kTilePacks; ++i) {
      double* sum = sums + p * kTile + i * kLanes;
      Store(sum, Load(sum) + Load(tile + p * kTile + i * kLanes) * known[i]);
    }
  }
}

PALPATE_INLINE double SumOfLanes(const double* lanes) {
  double sum = 0.0;
  for (int lane = 0; lane < kTile; ++lane) sum += lanes[lane];
  return sum;
}

template <typename Value>
void SolveBackwardOne(const FactorPanelOf<Value>& factor, const double* inverse, double* pivot_rows,
                      const int* below_rows, const double* all_rows, double* sums) {
  using Factor = FactorPanelOf<Value>;
  std::fill_n(sums, factor.pivots * kTile, 0.0);
  Pack known[kTilePacks];
  const Value* tile = factor.values + Factor::Size(factor.pivots, 0);
  for (int first = 0; first < factor.below; first += kTile, tile += factor.pivots * kTile) {
    alignas(64) double rows[kTile] = {};
    for (int r = 0; r < std::min(kTile, factor.below - first); ++r) {
      rows[r] = all_rows[below_rows[first + r]];
    }
    for (int i = 0; i < kTilePacks; ++i) known[i] = Load(rows + i * kLanes);
    AddProducts(tile, factor.pivots, known, sums);
  }
  for (int first = (factor.pivots - 1) / kTile * kTile; first >= 0; first -= kTile) {
    const int columns = std::min(kTile, factor.pivots - first);
    tile = factor.values + Factor::Size(first, 0);
    const Value* diagonal = tile + first * kTile;
    alignas(64) double y[kTile] = {};
    for (int c = 0; c < columns; ++c) {
      y[c] = pivot_rows[first + c] - SumOfLanes(sums + (first + c) * kTile);
    }
    for (int c = columns - 1; c >= 0; --c) {
      y[c] *= inverse[first + c];
      pivot_rows[first + c] = y[c];
      for (int b = 0; b < c; ++b) y[b] -= double{diagonal[b * kTile + c]} * y[c];
    }
    for (int i = 0; i < kTilePacks; ++i) known[i] = Load(y + i * kLanes);
    AddProducts(tile, first, known, sums);
  }
}

}  // namespace
