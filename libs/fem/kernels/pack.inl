// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "libs/fem/kernels/kernel.hpp"

/// Small fixed-size algebra on SIMD packs. Only for the kernel sources, inside their own namespace:
/// everything here is static, so that no instruction set's version is ever linked into another's.
namespace {

typedef double Pack __attribute__((vector_size(8 * palpate::fem::kernels::kLanes)));
typedef double UnalignedPack
    __attribute__((vector_size(8 * palpate::fem::kernels::kLanes), aligned(8)));

#define PALPATE_INLINE static inline __attribute__((always_inline))

PALPATE_INLINE Pack Load(const double* p) { return *reinterpret_cast<const UnalignedPack*>(p); }
PALPATE_INLINE void Store(double* p, Pack v) { *reinterpret_cast<UnalignedPack*>(p) = v; }
PALPATE_INLINE Pack Splat(double v) { return Pack{} + v; }

PALPATE_INLINE Pack Min(Pack a, Pack b) { return a < b ? a : b; }

PALPATE_INLINE Pack Log(Pack v) {
  Pack result{};
  for (int lane = 0; lane < palpate::fem::kernels::kLanes; ++lane) {
    result[lane] = __builtin_log(v[lane]);
  }
  return result;
}

struct Vec {
  Pack v[3];
};

struct Mat {
  Pack m[3][3];
};

PALPATE_INLINE Pack Dot(const Vec& a, const Vec& b) {
  return a.v[0] * b.v[0] + a.v[1] * b.v[1] + a.v[2] * b.v[2];
}

PALPATE_INLINE Vec Times(const Mat& a, const Vec& b) {
  Vec result;
  for (int i = 0; i < 3; ++i) {
    result.v[i] = a.m[i][0] * b.v[0] + a.m[i][1] * b.v[1] + a.m[i][2] * b.v[2];
  }
  return result;
}

PALPATE_INLINE Mat Times(const Mat& a, const Mat& b) {
  Mat result;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      result.m[i][j] = a.m[i][0] * b.m[0][j] + a.m[i][1] * b.m[1][j] + a.m[i][2] * b.m[2][j];
    }
  }
  return result;
}

/// a' b
PALPATE_INLINE Mat TransposeTimes(const Mat& a, const Mat& b) {
  Mat result;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      result.m[i][j] = a.m[0][i] * b.m[0][j] + a.m[1][i] * b.m[1][j] + a.m[2][i] * b.m[2][j];
    }
  }
  return result;
}

/// a b'
PALPATE_INLINE Mat TimesTranspose(const Mat& a, const Mat& b) {
  Mat result;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      result.m[i][j] = a.m[i][0] * b.m[j][0] + a.m[i][1] * b.m[j][1] + a.m[i][2] * b.m[j][2];
    }
  }
  return result;
}

/// alpha a + beta b
PALPATE_INLINE Mat Combine(Pack alpha, const Mat& a, Pack beta, const Mat& b) {
  Mat result;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) result.m[i][j] = alpha * a.m[i][j] + beta * b.m[i][j];
  }
  return result;
}

PALPATE_INLINE Mat Diagonal(Pack d) {
  const Pack zero = Splat(0.0);
  return {{{d, zero, zero}, {zero, d, zero}, {zero, zero, d}}};
}

PALPATE_INLINE Pack Trace(const Mat& a) { return a.m[0][0] + a.m[1][1] + a.m[2][2]; }

PALPATE_INLINE Pack SquaredNorm(const Mat& a) {
  Pack sum = Splat(0.0);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) sum += a.m[i][j] * a.m[i][j];
  }
  return sum;
}

/// Matrix of cofactors, d(det a)/da = det(a) a^-T.
PALPATE_INLINE Mat Cofactor(const Mat& a) {
  Mat c;
  for (int i = 0; i < 3; ++i) {
    const int i1 = (i + 1) % 3;
    const int i2 = (i + 2) % 3;
    for (int j = 0; j < 3; ++j) {
      const int j1 = (j + 1) % 3;
      const int j2 = (j + 2) % 3;
      c.m[i][j] = a.m[i1][j1] * a.m[i2][j2] - a.m[i1][j2] * a.m[i2][j1];
    }
  }
  return c;
}

PALPATE_INLINE Pack Determinant(const Mat& a, const Mat& cofactor) {
  return a.m[0][0] * cofactor.m[0][0] + a.m[0][1] * cofactor.m[0][1] + a.m[0][2] * cofactor.m[0][2];
}

/// Rotation R of the polar decomposition a = R S, by Newton's iteration R <- (R + R^-T) / 2 with
/// Higham's Frobenius-norm scaling. Needs det a > 0; ten steps reach rounding for condition numbers
/// up to 1e4.
PALPATE_INLINE Mat PolarRotation(const Mat& a) {
  Mat r = a;
  for (int step = 0; step < 10; ++step) {
    const Mat cofactor = Cofactor(r);
    const Pack inverse_det = 1.0 / Determinant(r, cofactor);
    const Pack ratio = SquaredNorm(cofactor) * inverse_det * inverse_det / SquaredNorm(r);
    Pack scale{};
    for (int lane = 0; lane < palpate::fem::kernels::kLanes; ++lane) {
      scale[lane] = __builtin_sqrt(__builtin_sqrt(ratio[lane]));
    }
    r = Combine(0.5 * scale, r, 0.5 * inverse_det / scale, cofactor);
  }
  return r;
}

}  // namespace
