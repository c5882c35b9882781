// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

/// The kernels of front_kernels.hpp. Included by one source for each instruction set, which defines
/// PALPATE_LANES of its registers and PALPATE_ACCUMULATORS, the registers that hold sums, before.
/// All is static, so that no instruction set's version is ever linked into another's.
#include <algorithm>
#include <limits>
#include <type_traits>

#include "libs/fem/sparse/dense/front_kernels.hpp"

namespace {

using palpate::fem::dense::FactorPanelOf;
using palpate::fem::dense::FrontKernels;
using palpate::fem::dense::kTile;
using palpate::fem::dense::Panel;
using palpate::fem::dense::Run;
using palpate::fem::dense::Update;

constexpr int kLanes = PALPATE_LANES;
typedef double Pack __attribute__((vector_size(8 * kLanes)));

#define PALPATE_INLINE static inline __attribute__((always_inline))

PALPATE_INLINE Pack Load(const double* p) { return *reinterpret_cast<const Pack*>(p); }
PALPATE_INLINE void Store(double* p, const Pack& v) { *reinterpret_cast<Pack*>(p) = v; }

typedef float RoundedPack __attribute__((vector_size(4 * kLanes), may_alias));
PALPATE_INLINE Pack Load(const float* p) {
  return __builtin_convertvector(*reinterpret_cast<const RoundedPack*>(p), Pack);
}
PALPATE_INLINE void Store(float* p, const Pack& v) {
  *reinterpret_cast<RoundedPack*>(p) = __builtin_convertvector(v, RoundedPack);
}

constexpr int kTilePacks = kTile / kLanes;
/// Packs of rows in the largest register tile of kTile columns.
constexpr int kRowPacks = std::max(PALPATE_ACCUMULATORS / kTile, kTilePacks);
/// Rows or columns whose sums are kept in registers together, where each has this many packs.
constexpr int Group(int packs) { return std::clamp(PALPATE_ACCUMULATORS / packs, 1, kTile); }

/// Columns that one pass over a large front eliminates or multiplies: what a pass reads stays in
/// the second-level cache.
constexpr int kPassColumns = 192;
constexpr int kPassRows = 480;

/// body(index) for the indices [begin, end), each known when this is built: loops over registers.
template <int begin, int end, typename Body>
PALPATE_INLINE void Unroll(const Body& body) {
  if constexpr (begin < end) {
    body(std::integral_constant<int, begin>{});
    Unroll<begin + 1, end>(body);
  }
}

/// sum[w] -= a b[w]' over `count` columns: a tile of packs x width, in groups of columns that fit
/// into the registers.
template <int packs, int width, int from = 0>
PALPATE_INLINE void SubtractProduct(const double* a, const double* b, long stride, int count,
                                    Pack (&sum)[width][packs]) {
  constexpr int to = std::min(width, from + Group(packs));
  const double* rows = a;
  const double* columns = b;
  for (int p = 0; p < count; ++p) {
    Pack row[packs];
    for (int i = 0; i < packs; ++i) row[i] = Load(rows + i * kLanes);
    for (int w = from; w < to; ++w) {
      for (int i = 0; i < packs; ++i) sum[w][i] -= row[i] * columns[w];
    }
    rows += stride;
    columns += stride;
  }
  if constexpr (to < width) SubtractProduct<packs, width, to>(a, b, stride, count, sum);
}

template <int packs, int width>
PALPATE_INLINE void LoadTile(const double* source, long stride, Pack (&tile)[width][packs]) {
  for (int w = 0; w < width; ++w) {
    for (int i = 0; i < packs; ++i) tile[w][i] = Load(source + w * stride + i * kLanes);
  }
}

template <int packs, int width>
PALPATE_INLINE void StoreTile(double* target, long stride, const Pack (&tile)[width][packs]) {
  for (int w = 0; w < width; ++w) {
    for (int i = 0; i < packs; ++i) Store(target + w * stride + i * kLanes, tile[w][i]);
  }
}

template <int width>
bool FactorTile(const Panel& panel, int begin, int first, double* tile, double* inverse) {
  const long stride = panel.stride;
  const double* row = panel.values + begin * stride + first;
  Pack sum[width][kTilePacks];
  LoadTile<kTilePacks, width>(panel.values + first * stride + first, stride, sum);
  SubtractProduct<kTilePacks, width>(row, row, stride, first - begin, sum);
  bool positive = true;
  Unroll<0, width>([&](auto j) __attribute__((always_inline)) {
    const double pivot = sum[j][j / kLanes][j % kLanes];
    positive &= pivot > 0.0 && pivot <= std::numeric_limits<double>::max();
    const double reciprocal = 1.0 / __builtin_sqrt(pivot);
    inverse[j] = reciprocal;
    for (int i = 0; i < kTilePacks; ++i) sum[j][i] *= reciprocal;
    Unroll<j + 1, width>([&](auto l) __attribute__((always_inline)) {
      const double factor = sum[j][l / kLanes][l % kLanes];
      for (int i = 0; i < kTilePacks; ++i) sum[l][i] -= sum[j][i] * factor;
    });
  });
  StoreTile<kTilePacks, width>(tile, kTile, sum);
  return positive;
}

template <int packs, int width>
PALPATE_INLINE void EliminateTile(const Panel& panel, int begin, int first, const double* tile,
                                  const double* inverse, int row) {
  const long stride = panel.stride;
  double* target = panel.values + first * stride + row;
  Pack sum[width][packs];
  LoadTile<packs, width>(target, stride, sum);
  SubtractProduct<packs, width>(panel.values + begin * stride + row,
                                panel.values + begin * stride + first, stride, first - begin, sum);
  Unroll<0, width>([&](auto w) __attribute__((always_inline)) {
    for (int i = 0; i < packs; ++i) sum[w][i] *= inverse[w];
    Unroll<w + 1, width>([&](auto v) __attribute__((always_inline)) {
      for (int i = 0; i < packs; ++i) sum[v][i] -= sum[w][i] * tile[w * kTile + v];
    });
  });
  StoreTile<packs, width>(target, stride, sum);
}

template <int width>
void EliminateRows(const Panel& panel, int begin, int first, const double* tile,
                   const double* inverse, int row_begin, int row_end) {
  int row = row_begin;
  for (; row + kRowPacks * kLanes <= row_end; row += kRowPacks * kLanes) {
    EliminateTile<kRowPacks, width>(panel, begin, first, tile, inverse, row);
  }
  for (; row < row_end; row += kTile) {
    EliminateTile<kTilePacks, width>(panel, begin, first, tile, inverse, row);
  }
}

/// target -= a b', or target = -a b', for one column tile and the rows [row, row_end) of `target`
/// and `a`.
template <int width, bool overwrite>
PALPATE_INLINE void SubtractColumns(double* target, long target_stride, const double* a,
                                    const double* b, long stride, int count, int row, int row_end) {
  const auto subtract = [&]<int packs>() __attribute__((always_inline)) {
    Pack sum[width][packs] = {};
    if constexpr (!overwrite) LoadTile<packs, width>(target + row, target_stride, sum);
    SubtractProduct<packs, width>(a + row, b, stride, count, sum);
    StoreTile<packs, width>(target + row, target_stride, sum);
    row += packs * kLanes;
  };
  while (row + kRowPacks * kLanes <= row_end) subtract.template operator()<kRowPacks>();
  if constexpr (kRowPacks > 2 * kTilePacks) {
    while (row + 2 * kTile <= row_end) subtract.template operator()<2 * kTilePacks>();
  }
  while (row < row_end) subtract.template operator()<kTilePacks>();
}

/// The switch from a number of columns known when the program runs to one known when it is built.
template <typename Call>
PALPATE_INLINE auto WithWidth(int width, const Call& call) {
  switch (width) {
    case 1: return call.template operator()<1>();
    case 2: return call.template operator()<2>();
    case 3: return call.template operator()<3>();
    case 4: return call.template operator()<4>();
    case 5: return call.template operator()<5>();
    case 6: return call.template operator()<6>();
    case 7: return call.template operator()<7>();
    default: return call.template operator()<8>();
  }
}

bool FactorAnyTile(const Panel& panel, int begin, int first, int width, double* tile,
                   double* inverse) {
  return WithWidth(width,
                   [&]<int w>() { return FactorTile<w>(panel, begin, first, tile, inverse); });
}

void EliminateAnyRows(const Panel& panel, int begin, int first, int width, const double* tile,
                      const double* inverse, int row_begin, int row_end) {
  WithWidth(width, [&]<int w>() {
    EliminateRows<w>(panel, begin, first, tile, inverse, row_begin, row_end);
  });
}

void UpdatePivots(const Panel& panel, int begin, int end, int column_begin, int column_end,
                  int row_begin, int row_end) {
  const long stride = panel.stride;
  const double* factor = panel.values + begin * stride;
  for (int rows = row_begin; rows < row_end; rows += kPassRows) {
    const int rows_end = std::min(rows + kPassRows, row_end);
    for (int column = column_begin; column < column_end; column += kTile) {
      if (column >= rows_end) break;
      WithWidth(std::min(kTile, column_end - column), [&]<int w>() {
        SubtractColumns<w, false>(panel.values + column * stride, stride, factor, factor + column,
                                  stride, end - begin, std::max(rows, column), rows_end);
      });
    }
  }
}

void UpdateBelow(const Panel& panel, const Update& update, int row_begin, int row_end) {
  const long stride = panel.stride;
  for (int begin = 0; begin < panel.pivots; begin += kPassColumns) {
    const int count = std::min(kPassColumns, panel.pivots - begin);
    const double* factor = panel.values + begin * stride + panel.PivotRows();
    for (int rows = row_begin; rows < row_end; rows += kPassRows) {
      const int rows_end = std::min(rows + kPassRows, row_end);
      for (int column = 0; column < std::min(rows_end, panel.below); column += kTile) {
        WithWidth(std::min(kTile, panel.below - column), [&]<int w>() {
          double* target = update.values + column * update.stride;
          const int row = std::max(rows, column);
          if (begin == 0) {
            SubtractColumns<w, true>(target, update.stride, factor, factor + column, stride, count,
                                     row, rows_end);
          } else {
            SubtractColumns<w, false>(target, update.stride, factor, factor + column, stride, count,
                                      row, rows_end);
          }
        });
      }
    }
  }
}

PALPATE_INLINE void ZeroRows(double* target, int count) {
  for (int row = 0; row < count; row += kLanes) Store(target + row, Pack{});
}

void Clear(const Panel& panel, int column_begin, int column_end) {
  const int rows = panel.Rows();
  for (int column = column_begin; column < std::min(column_end, panel.pivots); ++column) {
    const int row = column / kTile * kTile;
    ZeroRows(panel.values + column * panel.stride + row, rows - row);
  }
}

template <int lanes>
PALPATE_INLINE void AddLanes(double* target, long target_stride, const double* source,
                             long source_stride) {
  typedef double Lanes __attribute__((vector_size(8 * lanes), aligned(8)));
  for (int c = 0; c < 3; ++c) {
    *reinterpret_cast<Lanes*>(target + c * target_stride) +=
        *reinterpret_cast<const Lanes*>(source + c * source_stride);
  }
}

/// target += source in the three columns of a node, by loads and stores that never overlap: a store
/// followed by a load that overlaps it in part costs more than everything else here.
PALPATE_INLINE void AddRun(double* target, long target_stride, const double* source,
                           long source_stride, int length) {
  for (; length >= kTile; length -= kTile, target += kTile, source += kTile) {
    AddLanes<kTile>(target, target_stride, source, source_stride);
  }
  if (length & 4) {
    AddLanes<4>(target, target_stride, source, source_stride);
    target += 4, source += 4;
  }
  if (length & 2) {
    AddLanes<2>(target, target_stride, source, source_stride);
    target += 2, source += 2;
  }
  if (length & 1) {
    for (int c = 0; c < 3; ++c) target[c * target_stride] += source[c * source_stride];
  }
}

void ExtendAdd(const Update& child, const Run* runs, int run_count, const Panel& panel,
               const Update& update, int column_begin, int column_end) {
  const int pivot_rows = panel.PivotRows();
  for (int a = 0; a < run_count; ++a) {
    const Run& columns = runs[a];
    const int begin = std::max(0, column_begin - columns.target);
    const int end = std::min(columns.length, column_end - columns.target);
    const bool in_panel = columns.target < pivot_rows;
    const long stride = in_panel ? panel.stride : update.stride;
    double* front = in_panel ? panel.values : update.values - pivot_rows * (update.stride + 1);
    for (int c = begin; c < end; c += 3) {
      const double* source = child.values + (columns.source + c) * child.stride;
      double* target = front + (columns.target + c) * stride;
      AddRun(target + columns.target + c, stride, source + columns.source + c, child.stride,
             columns.length - c);
      for (int b = a + 1; b < run_count; ++b) {
        AddRun(target + runs[b].target, stride, source + runs[b].source, child.stride,
               runs[b].length);
      }
    }
  }
}

/// Columns of the tile of rows that starts at `row`, of a factor with so many pivots.
PALPATE_INLINE int TileColumns(int row, int pivots) { return std::min(row + kTile, pivots); }

template <typename Value>
void StoreFactor(const Panel& panel, const FactorPanelOf<Value>& factor, int tile_begin,
                 int tile_end) {
  using Factor = FactorPanelOf<Value>;
  const int begin = kTile * tile_begin;
  const int pivot_rows = panel.PivotRows();
  Value* target =
      factor.values + Factor::Size(std::min(begin, panel.pivots), std::max(0, begin - pivot_rows));
  if (begin > pivot_rows) {
    target = factor.values + Factor::Size(panel.pivots, begin - pivot_rows);
  }
  for (int row = begin; row < kTile * tile_end; row += kTile) {
    const int columns = TileColumns(row, panel.pivots);
    for (int p = 0; p < columns; ++p) {
      const double* source = panel.values + p * panel.stride + row;
      for (int i = 0; i < kTilePacks; ++i) Store(target + i * kLanes, Load(source + i * kLanes));
      target += kTile;
    }
  }
}

}  // namespace

#include "libs/fem/sparse/dense/front_substitution.inl"
#include "libs/fem/sparse/dense/front_substitution_one.inl"

namespace {

template <typename Value>
constexpr palpate::fem::dense::SubstitutionKernelsOf<Value> kSubstitution{
    .solve_forward = SolveForwardAny<Value>,
    .solve_backward = SolveBackwardAny<Value>,
    .solve_forward_one = SolveForwardOne<Value>,
    .solve_backward_one = SolveBackwardOne<Value>};

constexpr FrontKernels kKernels{.clear = Clear,
                                .extend_add = ExtendAdd,
                                .factor_tile = FactorAnyTile,
                                .eliminate_rows = EliminateAnyRows,
                                .update_pivots = UpdatePivots,
                                .update_below = UpdateBelow,
                                .store = StoreFactor<double>,
                                .store_single = StoreFactor<float>,
                                .exact = kSubstitution<double>,
                                .rounded = kSubstitution<float>};

}  // namespace
