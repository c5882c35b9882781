// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#if defined(__SSE2__)
#include <immintrin.h>
#endif

#include <cstdint>

/// SIMD lanes. Only for the kernel sources, inside their own namespace: everything here is static,
/// so that no instruction set's version is ever linked into another's.
namespace {

#if defined(__AVX512F__)
constexpr int kWidth = 16;
#elif defined(__AVX2__)
constexpr int kWidth = 8;
#else
constexpr int kWidth = 4;
#endif
constexpr int kHalf = kWidth / 2;

typedef float Float __attribute__((vector_size(4 * kWidth)));
typedef std::int32_t Int __attribute__((vector_size(4 * kWidth)));  ///< also masks: -1 or 0
typedef std::uint32_t Word __attribute__((vector_size(4 * kWidth)));
typedef double Double __attribute__((vector_size(8 * kHalf)));
typedef std::int64_t DoubleMask __attribute__((vector_size(8 * kHalf)));
typedef float HalfFloat __attribute__((vector_size(4 * kHalf)));
typedef std::int32_t HalfInt __attribute__((vector_size(4 * kHalf)));
typedef std::uint32_t HalfWord __attribute__((vector_size(4 * kHalf)));

template <typename Pack, typename T>
struct Memory {
  typedef Pack Type __attribute__((aligned(sizeof(T)), may_alias));
};

#define PALPATE_LANES static inline __attribute__((always_inline))

template <typename Pack, typename T>
PALPATE_LANES Pack LoadAs(const T* p) {
  return *reinterpret_cast<const typename Memory<Pack, T>::Type*>(p);
}
PALPATE_LANES Float Load(const float* p) { return LoadAs<Float>(p); }
PALPATE_LANES Word Load(const std::uint32_t* p) { return LoadAs<Word>(p); }
PALPATE_LANES Double Load(const double* p) { return LoadAs<Double>(p); }

template <typename Pack, typename T>
PALPATE_LANES void Store(T* p, Pack v) {
  *reinterpret_cast<typename Memory<Pack, T>::Type*>(p) = v;
}

PALPATE_LANES Float Splat(float v) { return Float{} + v; }
PALPATE_LANES Double Splat(double v) { return Double{} + v; }
PALPATE_LANES Word Splat(std::uint32_t v) { return Word{} + v; }
PALPATE_LANES Int Splat(std::int32_t v) { return Int{} + v; }

PALPATE_LANES Float Min(Float a, Float b) { return a < b ? a : b; }
PALPATE_LANES Float Max(Float a, Float b) { return a > b ? a : b; }
PALPATE_LANES Float Abs(Float v) {
  return reinterpret_cast<Float>(reinterpret_cast<Int>(v) & 0x7fffffff);
}
PALPATE_LANES Float Clamp(Float v, float low, float high) {
  return Min(Max(v, Splat(low)), Splat(high));
}

template <typename Pack>
PALPATE_LANES Pack Sqrt(Pack v) {
  Pack result{};
  for (int lane = 0; lane < static_cast<int>(sizeof(Pack) / sizeof(v[0])); ++lane) {
    if constexpr (sizeof(v[0]) == 4) {
      result[lane] = __builtin_sqrtf(v[lane]);
    } else {
      result[lane] = __builtin_sqrt(v[lane]);
    }
  }
  return result;
}

PALPATE_LANES Int ToInt(Float v) { return __builtin_convertvector(v, Int); }
PALPATE_LANES Float ToFloat(Int v) { return __builtin_convertvector(v, Float); }

/// a + b, which may wrap round: unused lanes hold any value.
PALPATE_LANES Int Sum(Int a, Int b) {
  return reinterpret_cast<Int>(reinterpret_cast<Word>(a) + reinterpret_cast<Word>(b));
}

/// Whole number that is not larger; |v| < 2^31.
PALPATE_LANES Int Floor(Float v) {
  const Int truncated = ToInt(v);
  return Sum(truncated, ToFloat(truncated) > v);
}

/// 0, 1, 2, ...
template <typename Pack>
PALPATE_LANES Pack LanesOf() {
  Pack lanes{};
  for (int lane = 0; lane < static_cast<int>(sizeof(Pack) / 4); ++lane) lanes[lane] = lane;
  return lanes;
}
PALPATE_LANES Int Lanes() { return LanesOf<Int>(); }

PALPATE_LANES bool Any(Int mask) {
#if defined(__AVX512F__)
  return _mm512_movepi32_mask(reinterpret_cast<__m512i>(mask)) != 0;
#elif defined(__AVX2__)
  return _mm256_movemask_ps(reinterpret_cast<__m256>(mask)) != 0;
#elif defined(__SSE2__)
  return _mm_movemask_ps(reinterpret_cast<__m128>(mask)) != 0;
#else
  std::int32_t any = 0;
  for (int lane = 0; lane < kWidth; ++lane) any |= mask[lane];
  return any != 0;
#endif
}

PALPATE_LANES bool Any(HalfInt mask) {
  Int whole{};
  __builtin_memcpy(&whole, &mask, sizeof(mask));
  return Any(whole);
}

/// Every bit of the result depends on every bit of `h` (Wellons' "lowbias32").
template <typename T>
PALPATE_LANES T Scramble(T h) {
  h ^= h >> 16;
  h *= 0x7feb352dU;
  h ^= h >> 15;
  h *= 0x846ca68bU;
  h ^= h >> 16;
  return h;
}

/// A random word of the counter, another one for each key.
template <typename T>
PALPATE_LANES T RandomWord(T counter, std::uint32_t key_low, std::uint32_t key_high) {
  return Scramble(T(counter * (key_high | 1U) + key_low));
}

}  // namespace
