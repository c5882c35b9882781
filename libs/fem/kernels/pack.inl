// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#if defined(__AVX2__)
#include <immintrin.h>
#endif

#include "libs/fem/kernels/kernel.hpp"

/// SIMD packs and their scalar functions. Only for the kernel sources, inside their own namespace:
/// everything here is static, so that no instruction set's version is ever linked into another's.
namespace {

using palpate::fem::kernels::kLanes;

/// Lanes that one register holds: as many elements are computed at a time.
#if defined(__AVX512F__)
constexpr int kWidth = 8;
#elif defined(__AVX2__)
constexpr int kWidth = 4;
#else
constexpr int kWidth = 2;
#endif

typedef double Pack __attribute__((vector_size(8 * kWidth)));
typedef double UnalignedPack __attribute__((vector_size(8 * kWidth), aligned(8), may_alias));
typedef long Mask __attribute__((vector_size(8 * kWidth)));  ///< -1 or 0 in each lane

#define PALPATE_INLINE static inline __attribute__((always_inline))

PALPATE_INLINE Pack Load(const double* p) { return *reinterpret_cast<const UnalignedPack*>(p); }
PALPATE_INLINE void Store(double* p, Pack v) { *reinterpret_cast<UnalignedPack*>(p) = v; }
PALPATE_INLINE Pack Splat(double v) { return Pack{} + v; }

PALPATE_INLINE Pack Min(Pack a, Pack b) { return a < b ? a : b; }

PALPATE_INLINE bool AllOf(Mask mask) {
#if defined(__AVX512F__)
  return _mm512_movepi64_mask(reinterpret_cast<__m512i>(mask)) == 0xff;
#elif defined(__AVX2__)
  return _mm256_movemask_pd(reinterpret_cast<__m256d>(mask)) == 0xf;
#else
  return (mask[0] & mask[1]) != 0;
#endif
}

PALPATE_INLINE Pack Sqrt(Pack v) {
  Pack result{};
  for (int lane = 0; lane < kWidth; ++lane) result[lane] = __builtin_sqrt(v[lane]);
  return result;
}

PALPATE_INLINE Pack Log(Pack v) {
  Pack result{};
  for (int lane = 0; lane < kWidth; ++lane) result[lane] = __builtin_log(v[lane]);
  return result;
}

/// v^(-1/3), v > 0, normal: a third of the exponent off (3.5 % right), then Newton's iteration.
PALPATE_INLINE Pack InverseCubeRoot(Pack v) {
  const Mask bits = reinterpret_cast<Mask>(v);
  Mask third = bits >> 2;  // 1/4 (1 + 1/4) (1 + 1/16) (1 + 1/256) = 1/3 - 5e-6
  third += third >> 2;
  third += third >> 4;
  third += third >> 8;
  Pack root = reinterpret_cast<Pack>(0x553ef0ff289dd796L - third);
  for (int step = 0; step < 4; ++step) {
    root += root * (1.0 / 3.0) * (1.0 - v * root * root * root);
  }
  return root;
}

}  // namespace
