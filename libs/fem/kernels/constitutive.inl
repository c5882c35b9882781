// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "libs/fem/kernels/matrix.inl"

/// Constitutive laws at one integration point (libs/fem/material.hpp gives their stresses).
/// Each law offers the first Piola-Kirchhoff stress P(F), the energy density, and the tangent
/// between two nodes with shape gradients G_a, G_b and images v = map G, d = second_map G:
///   K_ab = G_a . dP/dF . G_b = iso (G_a . G_b) I + main v_a v_b' + skew (v_a v_b' - v_b v_a')
///          + what is the law's own (see Traits).
/// The volumetric laws take p = dU/dJ and U'' from outside, so that the caller decides whether J is
/// the point's or the element's mean.
namespace {

using palpate::fem::MaterialModel;

struct Moduli {
  Pack lambda;
  Pack mu;
  Pack c20_over_c10;
  Pack c30_over_c10;
};

/// State of one integration point.
struct Point {
  Mat F;
  Mat cofactor;  ///< of F, not of the linear, corotational and StVK laws
  Pack J;
  Pack weight;
  Mat P;
  Pack energy;
  Pack iso, main, skew;  ///< coefficients of the tangent above
  Mat map;               ///< v = map G
  Mat second_map;        ///< d = second_map G; StVK: the stress S instead
  Pack second, cross;    ///< coefficients of d_a d_b' and of d_a v_b' + v_a d_b'
  Mat tensor;            ///< symmetric
};

/// Parts of the tangent that a law has.
template <MaterialModel model>
struct Traits {
  /// Its energy has a part of the volume ratio alone.
  static constexpr bool kVolumetric =
      model != MaterialModel::kCorotational && model != MaterialModel::kStVenantKirchhoff;
  static constexpr bool kSkew = model != MaterialModel::kCorotational;
  /// Yeoh: second d_a d_b' + cross (d_a v_b' + v_a d_b').
  static constexpr bool kIsochoric = model == MaterialModel::kYeoh;
  /// Corotational, from how the rotation turns: second (d_b d_a' - (v_a . d_b) tensor).
  static constexpr bool kRotation = model == MaterialModel::kCorotational;
  /// StVK: iso (G_a . G_b) tensor, and G_a . S G_b in place of iso (G_a . G_b).
  static constexpr bool kGreen = model == MaterialModel::kStVenantKirchhoff;
  static constexpr bool kSecondImage = kIsochoric || kRotation;
};

/// U, dU/dJ and d2U/dJ2 of the volumetric energy, at the volume ratio J: of what lambda multiplies.
/// What mu multiplies stays with the point, so that averaging J leaves the element stable: of the
/// stable neo-Hookean energy (lambda + mu) / 2 (J - alpha)^2 = lambda / 2 (J - 1)^2 +
/// mu / 2 (J - 1)^2 - mu (J - 1) + constant, the first term only; of the Yeoh energy
/// (lambda + 2/3 mu) / 2 (J - 1)^2 likewise.
struct VolumetricLaw {
  Pack U;
  Pack dU;
  Pack ddU;
};

template <MaterialModel model>
PALPATE_INLINE VolumetricLaw EvaluateVolumetric(Pack J, Pack lambda) {
  if constexpr (model == MaterialModel::kNeoHookean) {
    const Pack log_J = Log(J);
    return {0.5 * lambda * log_J * log_J, lambda * log_J / J, lambda * (1.0 - log_J) / (J * J)};
  } else {  // linear in J; of the linear law J stands for 1 + tr(eps)
    const Pack change = J - 1.0;
    return {0.5 * lambda * change * change, lambda * change, lambda};
  }
}

/// P = mu F + p cof F, p a function of J.
PALPATE_INLINE void SetNeoHookeanTangent(Pack mu, Pack pressure, Pack d_pressure, Point& point) {
  point.P = Combine(mu, point.F, pressure, point.cofactor);
  point.iso = mu;
  point.main = d_pressure;
  point.skew = pressure / point.J;
  point.map = point.cofactor;
}

PALPATE_INLINE void EvaluateStableNeoHookean(const VolumetricLaw& law, const Moduli& moduli,
                                             Point& point) {
  const Pack mu = moduli.mu;
  const Pack J = point.J;
  point.energy = 0.5 * mu * (SquaredNorm(point.F) - 3.0) + 0.5 * mu * (J - 1.0) * (J - 3.0) + law.U;
  SetNeoHookeanTangent(mu, law.dU + mu * (J - 2.0), law.ddU + mu, point);
}

PALPATE_INLINE void EvaluateNeoHookean(const VolumetricLaw& law, const Moduli& moduli,
                                       bool with_energy, Point& point) {
  const Pack mu = moduli.mu;
  const Pack inverse_J = 1.0 / point.J;
  point.energy = law.U;
  if (with_energy) {
    point.energy += 0.5 * mu * (SquaredNorm(point.F) - 3.0) - mu * Log(point.J);
  }
  SetNeoHookeanTangent(mu, law.dU - mu * inverse_J, law.ddU + mu * inverse_J * inverse_J, point);
}

/// With I1 = F : F, the isochoric invariant I = J^(-2/3) I1 and its derivative
/// D = dI/dF = 2 J^(-2/3) (F - I1 / (3 J) cof F), W = W(I) + U(J):
///   P = W' D + U' cof F,   d = D G,
///   W' d2I/dF2 = 2 W' J^(-2/3) (G_a . G_b) I - 2/3 W'/J (d_a v_b' + v_a d_b')
///                + 2/9 W' I/J^2 v_a v_b' - 2/3 W' I/J^2 (v_a v_b' - v_b v_a').
PALPATE_INLINE void EvaluateYeoh(const VolumetricLaw& law, const Moduli& moduli, Point& point) {
  const Pack mu = moduli.mu;
  const Pack c20 = moduli.c20_over_c10;
  const Pack c30 = moduli.c30_over_c10;
  const Pack inverse_J = 1.0 / point.J;
  const Pack root = InverseCubeRoot(point.J);
  const Pack isochoric = root * root;
  const Pack I1 = SquaredNorm(point.F);
  const Pack stretch = isochoric * I1 - 3.0;
  const Pack change = point.J - 1.0;
  point.energy = 0.5 * mu * stretch * (1.0 + stretch * (c20 + stretch * c30)) +
                 (1.0 / 3.0) * mu * change * change + law.U;
  const Pack two_dW = mu * (1.0 + stretch * (2.0 * c20 + 3.0 * c30 * stretch));
  const Pack pressure = law.dU + (2.0 / 3.0) * mu * change;
  const Pack volume_part = two_dW * (stretch + 3.0) * inverse_J * inverse_J;
  point.second_map =
      Combine(2.0 * isochoric, point.F, (-2.0 / 3.0) * isochoric * I1 * inverse_J, point.cofactor);
  point.P = Combine(0.5 * two_dW, point.second_map, pressure, point.cofactor);
  point.map = point.cofactor;
  point.iso = two_dW * isochoric;
  point.main = law.ddU + (2.0 / 3.0) * mu + (1.0 / 9.0) * volume_part;
  point.skew = pressure * inverse_J - (1.0 / 3.0) * volume_part;
  point.second = mu * (c20 + 3.0 * c30 * stretch);
  point.cross = (-1.0 / 3.0) * two_dW * inverse_J;
}

PALPATE_INLINE void EvaluateLinear(const VolumetricLaw& law, const Moduli& moduli, Point& point) {
  Mat strain;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) strain.m[i][j] = 0.5 * (point.F.m[i][j] + point.F.m[j][i]);
    strain.m[i][i] -= 1.0;
  }
  point.P = Combine(2.0 * moduli.mu, strain, Splat(1.0), Diagonal(law.dU));
  point.energy = moduli.mu * SquaredNorm(strain) + law.U;
  point.map = Diagonal(Splat(1.0));
  point.iso = moduli.mu;
  point.main = law.ddU + moduli.mu;
  point.skew = -moduli.mu;
}

PALPATE_INLINE void EvaluateStVenantKirchhoff(const Moduli& moduli, Point& point) {
  Mat green = TransposeTimes(point.F, point.F);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) green.m[i][j] = 0.5 * (green.m[i][j] - (i == j ? 1.0 : 0.0));
  }
  const Pack trace = Trace(green);
  point.second_map = Combine(2.0 * moduli.mu, green, Splat(1.0), Diagonal(moduli.lambda * trace));
  point.P = Times(point.F, point.second_map);
  point.energy = moduli.mu * SquaredNorm(green) + 0.5 * moduli.lambda * trace * trace;
  point.map = point.F;
  point.tensor = TimesTranspose(point.F, point.F);
  point.iso = moduli.mu;
  point.main = moduli.lambda + moduli.mu;
  point.skew = -moduli.mu;
}

/// With dF = e_k G_b' the rotation changes by dR = [w]_x R, T w = v_b x e_k, T = tr(V) I - V, V the
/// left stretch. From T^-1 = cof(T) / det(T) and cof(T) (x cross y) = T x cross T y follows
///   [v_a]_x' T^-1 [v_b]_x = ((v_a . T v_b) T - (T v_b)(T v_a)') / det(T).
PALPATE_INLINE void EvaluateCorotational(const Moduli& moduli, Point& point) {
  const Mat rotation = PolarRotation(point.F);
  const Mat left_stretch = TimesTranspose(point.F, rotation);
  const Pack stretch_trace = Trace(left_stretch);
  const Pack volumetric = moduli.lambda * (stretch_trace - 3.0);
  const Pack turned = volumetric - 2.0 * moduli.mu;
  point.P = Combine(2.0 * moduli.mu, point.F, turned, rotation);
  point.energy = moduli.mu * SquaredNorm(Combine(Splat(1.0), point.F, Splat(-1.0), rotation)) +
                 0.5 * volumetric * (stretch_trace - 3.0);
  point.map = rotation;
  point.tensor = Combine(Splat(1.0), Diagonal(stretch_trace), Splat(-1.0), left_stretch);
  point.second_map = Times(point.tensor, rotation);
  point.second = -turned / Determinant(point.tensor, Cofactor(point.tensor));
  point.iso = 2.0 * moduli.mu;
  point.main = moduli.lambda;
}

template <MaterialModel model>
PALPATE_INLINE void EvaluateLaw(const VolumetricLaw& law, const Moduli& moduli, bool with_energy,
                                Point& point) {
  if constexpr (model == MaterialModel::kLinear) {
    EvaluateLinear(law, moduli, point);
  } else if constexpr (model == MaterialModel::kCorotational) {
    EvaluateCorotational(moduli, point);
  } else if constexpr (model == MaterialModel::kStVenantKirchhoff) {
    EvaluateStVenantKirchhoff(moduli, point);
  } else if constexpr (model == MaterialModel::kNeoHookean) {
    EvaluateNeoHookean(law, moduli, with_energy, point);
  } else if constexpr (model == MaterialModel::kStableNeoHookean) {
    EvaluateStableNeoHookean(law, moduli, point);
  } else {
    EvaluateYeoh(law, moduli, point);
  }
}

}  // namespace
