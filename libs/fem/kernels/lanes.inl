// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "libs/fem/kernels/matrix.inl"

/// Moves between lanes and plain memory: nodes are gathered into lanes, results of lanes become
/// rows of eight doubles, one row for each lane.
namespace {

typedef double Pair __attribute__((vector_size(16)));
typedef double UnalignedPair __attribute__((vector_size(16), aligned(8), may_alias));

typedef double UnalignedQuad __attribute__((vector_size(32), aligned(8), may_alias));

/// Eight doubles.
struct Row {
  Pack part[8 / kWidth];
};

PALPATE_INLINE Pair LoadPair(const double* p) { return *reinterpret_cast<const UnalignedPair*>(p); }

#define PALPATE_LOW_LANES(a, b) __builtin_shufflevector(a, b, PALPATE_LOW)
#define PALPATE_HIGH_LANES(a, b) __builtin_shufflevector(a, b, PALPATE_HIGH)

#if defined(__AVX512F__)

#define PALPATE_LOW 0, 8, 2, 10, 4, 12, 6, 14
#define PALPATE_HIGH 1, 9, 3, 11, 5, 13, 7, 15

/// lanes[0] | lanes[2] | lanes[4] | lanes[6]
PALPATE_INLINE Pack JoinEverySecond(const Pair* lanes) {
  const auto low = __builtin_shufflevector(lanes[0], lanes[2], 0, 1, 2, 3);
  const auto high = __builtin_shufflevector(lanes[4], lanes[6], 0, 1, 2, 3);
  return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
}

PALPATE_INLINE Pack EvenPairs(Pack a, Pack b) {
  return __builtin_shufflevector(a, b, 0, 1, 4, 5, 8, 9, 12, 13);
}

PALPATE_INLINE Pack OddPairs(Pack a, Pack b) {
  return __builtin_shufflevector(a, b, 2, 3, 6, 7, 10, 11, 14, 15);
}

/// Rows of every second lane, from entries (0, 1), (2, 3), (4, 5), (6, 7) side by side.
PALPATE_INLINE void MakeEverySecondRow(const Pack (&side_by_side)[4], Row* rows) {
  const Pack even_low = EvenPairs(side_by_side[0], side_by_side[1]);
  const Pack even_high = EvenPairs(side_by_side[2], side_by_side[3]);
  const Pack odd_low = OddPairs(side_by_side[0], side_by_side[1]);
  const Pack odd_high = OddPairs(side_by_side[2], side_by_side[3]);
  rows[0].part[0] = EvenPairs(even_low, even_high);
  rows[2].part[0] = EvenPairs(odd_low, odd_high);
  rows[4].part[0] = OddPairs(even_low, even_high);
  rows[6].part[0] = OddPairs(odd_low, odd_high);
}

#elif defined(__AVX2__)

#define PALPATE_LOW 0, 4, 2, 6
#define PALPATE_HIGH 1, 5, 3, 7

PALPATE_INLINE Pack JoinEverySecond(const Pair* lanes) {
  return __builtin_shufflevector(lanes[0], lanes[2], 0, 1, 2, 3);
}

PALPATE_INLINE void MakeEverySecondRow(const Pack (&side_by_side)[4], Row* rows) {
  for (int half = 0; half < 2; ++half) {
    const Pack a = side_by_side[2 * half];
    const Pack b = side_by_side[2 * half + 1];
    rows[0].part[half] = __builtin_shufflevector(a, b, 0, 1, 4, 5);
    rows[2].part[half] = __builtin_shufflevector(a, b, 2, 3, 6, 7);
  }
}

#else

#define PALPATE_LOW 0, 2
#define PALPATE_HIGH 1, 3

PALPATE_INLINE Pack JoinEverySecond(const Pair* lanes) { return lanes[0]; }

PALPATE_INLINE void MakeEverySecondRow(const Pack (&side_by_side)[4], Row* rows) {
  for (int k = 0; k < 4; ++k) rows[0].part[k] = side_by_side[k];
}

#endif

/// rows[lane] = entries[0 .. 7] of that lane.
PALPATE_INLINE void MakeRows(const Pack (&entries)[8], Row (&rows)[kWidth]) {
  Pack even[4];
  Pack odd[4];
  for (int k = 0; k < 4; ++k) {
    even[k] = PALPATE_LOW_LANES(entries[2 * k], entries[2 * k + 1]);
    odd[k] = PALPATE_HIGH_LANES(entries[2 * k], entries[2 * k + 1]);
  }
  MakeEverySecondRow(even, rows);
  MakeEverySecondRow(odd, rows + 1);
}

/// Adds a row to eight doubles at `target`.
PALPATE_INLINE void AddRow(const Row& row, double* target) {
  for (int k = 0; k < 8 / kWidth; ++k) {
    Store(target + k * kWidth, Load(target + k * kWidth) + row.part[k]);
  }
}

/// Adds the first four doubles of a row at `low`, the others at `high`.
PALPATE_INLINE void AddHalfRows(const Row& row, double* low, double* high) {
  double entries[8];
  for (int k = 0; k < 8 / kWidth; ++k) Store(entries + k * kWidth, row.part[k]);
  *reinterpret_cast<UnalignedQuad*>(low) += *reinterpret_cast<const UnalignedQuad*>(entries);
  *reinterpret_cast<UnalignedQuad*>(high) += *reinterpret_cast<const UnalignedQuad*>(entries + 4);
}

/// One node of each lane: x, y, z at x_m + 3 nodes[lane].
PALPATE_INLINE Vec GatherNode(const double* x_m, const int* nodes) {
  Pair xy[kWidth];
  Pack z;
  for (int lane = 0; lane < kWidth; ++lane) {
    const double* x = x_m + 3 * static_cast<long>(nodes[lane]);
    xy[lane] = LoadPair(x);
    z[lane] = x[2];
  }
  const Pack even = JoinEverySecond(xy);
  const Pack odd = JoinEverySecond(xy + 1);
  return {{PALPATE_LOW_LANES(even, odd), PALPATE_HIGH_LANES(even, odd), z}};
}

}  // namespace
