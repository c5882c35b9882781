// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "libs/fem/kernels/pack.inl"

/// Constitutive laws at one integration point (libs/fem/material.hpp gives their stresses).
/// Each law offers the first Piola-Kirchhoff stress P(F), the energy density, and the tangent
/// between two nodes with shape gradients G_a, G_b:
///   K_ab = G_a . dP/dF . G_b = s (G_a . G_b) I + A v_a v_b' + B v_b v_a' + (what is its own).
/// The volumetric laws take p = dU/dJ and U'' from outside, so that the caller decides whether J is
/// the point's or the element's mean.
namespace {

using palpate::fem::MaterialModel;

/// U, dU/dJ and d2U/dJ2 of the volumetric energy, at the volume ratio J: of what lambda multiplies.
/// What mu multiplies stays with the point, so that averaging J leaves the element stable: of the
/// stable neo-Hookean energy (lambda + mu) / 2 (J - alpha)^2 = lambda / 2 (J - 1)^2 +
/// mu / 2 (J - 1)^2 - mu (J - 1) + constant, the first term only.
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
  } else {  // stable neo-Hookean; linear, where J stands for 1 + tr(eps)
    const Pack change = J - 1.0;
    return {0.5 * lambda * change * change, lambda * change, lambda};
  }
}

/// State of one integration point, filled by EvaluatePoint.
struct PointState {
  Mat F;
  Mat P;
  Pack J;
  Pack energy;
  Pack s, A, B;  ///< coefficients of the tangent above
  Mat node_map;  ///< v_a = node_map G_a
  Mat extra;     ///< StVK: F F' and, in second, S; corotational: (tr(V) I - V)^-1
  Mat second;
  Pack kappa;  ///< corotational: lambda tr(S - I) - 2 mu
};

template <MaterialModel model>
PALPATE_INLINE void EvaluateJBased(const VolumetricLaw& law, bool pointwise, Pack mu,
                                   PointState& point) {
  const Mat cofactor = Cofactor(point.F);
  const Pack J = point.J;
  const Pack square = SquaredNorm(point.F) - 3.0;
  const Pack ddU = pointwise ? law.ddU : Splat(0.0);
  point.s = mu;
  point.node_map = cofactor;
  if constexpr (model == MaterialModel::kStableNeoHookean) {
    const Pack pressure = law.dU + mu * (J - 2.0);
    point.P = Combine(mu, point.F, pressure, cofactor);
    point.energy = 0.5 * mu * square + 0.5 * mu * (J - 1.0) * (J - 3.0);
    point.A = ddU + mu + pressure / J;
    point.B = -pressure / J;
  } else {
    point.P = Combine(mu, point.F, law.dU - mu / J, cofactor);
    point.energy = 0.5 * mu * square - mu * Log(J);
    point.A = ddU + law.dU / J;
    point.B = mu / (J * J) - law.dU / J;
  }
}

PALPATE_INLINE void EvaluateLinear(const VolumetricLaw& law, bool pointwise, Pack mu,
                                   PointState& point) {
  Mat strain;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) strain.m[i][j] = 0.5 * (point.F.m[i][j] + point.F.m[j][i]);
    strain.m[i][i] -= 1.0;
  }
  point.P = Combine(2.0 * mu, strain, Splat(1.0), Diagonal(law.dU));
  point.energy = mu * SquaredNorm(strain);
  point.node_map = Diagonal(Splat(1.0));
  point.s = mu;
  point.A = pointwise ? law.ddU : Splat(0.0);
  point.B = mu;
}

PALPATE_INLINE void EvaluateStVenantKirchhoff(Pack lambda, Pack mu, PointState& point) {
  Mat green = TransposeTimes(point.F, point.F);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) green.m[i][j] = 0.5 * (green.m[i][j] - (i == j ? 1.0 : 0.0));
  }
  const Pack trace = Trace(green);
  point.second = Combine(2.0 * mu, green, Splat(1.0), Diagonal(lambda * trace));
  point.P = Times(point.F, point.second);
  point.energy = mu * SquaredNorm(green) + 0.5 * lambda * trace * trace;
  point.node_map = point.F;
  point.extra = TimesTranspose(point.F, point.F);
  point.s = mu;
  point.A = lambda;
  point.B = mu;
}

/// With dF = e_k G_b' the rotation changes by dR = R [w]_x, (tr(S) I - S) w = G_b x (R' e_k).
PALPATE_INLINE void EvaluateCorotational(Pack lambda, Pack mu, PointState& point) {
  const Mat rotation = PolarRotation(point.F);
  const Mat left_stretch = TimesTranspose(point.F, rotation);
  const Pack stretch_trace = Trace(left_stretch);
  const Pack volumetric = lambda * (stretch_trace - 3.0);
  point.P = Combine(2.0 * mu, point.F, volumetric - 2.0 * mu, rotation);
  point.energy = mu * SquaredNorm(Combine(Splat(1.0), point.F, Splat(-1.0), rotation)) +
                 0.5 * lambda * (stretch_trace - 3.0) * (stretch_trace - 3.0);
  point.node_map = rotation;
  const Mat spin = Combine(Splat(1.0), Diagonal(stretch_trace), Splat(-1.0), left_stretch);
  const Mat spin_cofactor = Cofactor(spin);
  const Pack spin_det = Determinant(spin, spin_cofactor);
  point.extra = Combine(1.0 / spin_det, spin_cofactor, Splat(0.0), spin);
  point.kappa = volumetric - 2.0 * mu;
  point.s = 2.0 * mu;
  point.A = lambda;
  point.B = Splat(0.0);
}

}  // namespace
