// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "libs/fem/kernels/pack.inl"

/// Vectors and 3x3 matrices of packs.
namespace {

struct Vec {
  Pack v[3];
};

struct Mat {
  Pack m[3][3];
};

PALPATE_INLINE Vec Scale(Pack alpha, const Vec& a) {
  return {{alpha * a.v[0], alpha * a.v[1], alpha * a.v[2]}};
}

/// alpha a + beta b
PALPATE_INLINE Vec Combine(Pack alpha, const Vec& a, Pack beta, const Vec& b) {
  Vec result;
  for (int i = 0; i < 3; ++i) result.v[i] = alpha * a.v[i] + beta * b.v[i];
  return result;
}

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

PALPATE_INLINE Mat Scale(Pack alpha, const Mat& a) {
  Mat result;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) result.m[i][j] = alpha * a.m[i][j];
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

/// Rotation R of the polar decomposition a = R S, by Newton's iteration R <- (R + R^-T) / 2, with
/// Higham's Frobenius-norm scaling until a lane is near. Needs det a > 0; ten steps reach rounding
/// for condition numbers up to 1e4, four or five are usual. A lane that has converged keeps its
/// value: what an element gives does not depend on those beside it.
PALPATE_INLINE Mat PolarRotation(const Mat& a) {
  constexpr int kMaxSteps = 10;
  constexpr double kNear = 0.05;        // squared change, from where on scaling does not help
  constexpr double kConverged = 1e-16;  // squared change; the error left is half of it
  Mat r = a;
  Mask near = Mask{};
  Mask converged = Mask{};
  for (int step = 0; step < kMaxSteps; ++step) {
    const Mat cofactor = Cofactor(r);
    const Pack inverse_det = 1.0 / Determinant(r, cofactor);
    Pack forward = Splat(0.5);
    Pack back = 0.5 * inverse_det;
    if (!AllOf(near)) {
      const Pack ratio = SquaredNorm(cofactor) * inverse_det * inverse_det / SquaredNorm(r);
      const Pack scale = Sqrt(Sqrt(ratio));
      forward = near ? forward : 0.5 * scale;
      back = near ? back : 0.5 * inverse_det / scale;
    }
    const Mat next = Combine(forward, r, back, cofactor);
    const Pack change = SquaredNorm(Combine(Splat(1.0), next, Splat(-1.0), r));
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) r.m[i][j] = converged ? r.m[i][j] : next.m[i][j];
    }
    near |= change < kNear;
    converged |= change < kConverged;
    if (AllOf(converged)) break;
  }
  return r;
}

}  // namespace
