// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

/// The element kernel: eight elements in the lanes of a pack. Included by one source for each
/// instruction set.
#include "libs/fem/kernels/constitutive.inl"
#include "libs/fem/kernels/kernel.hpp"
#include "libs/fem/kernels/pack.inl"

namespace {

using palpate::fem::kernels::Block;
using palpate::fem::kernels::Kernel;
using palpate::fem::kernels::kLanes;
using palpate::fem::kernels::Output;
using palpate::fem::kernels::PairCount;
using palpate::fem::kernels::PairIndex;

constexpr bool IsJBased(MaterialModel model) {
  return model == MaterialModel::kStableNeoHookean || model == MaterialModel::kNeoHookean;
}

constexpr bool HasVolumetricLaw(MaterialModel model) {
  return IsJBased(model) || model == MaterialModel::kLinear;
}

template <int kNodes>
struct Positions {
  Vec x[kNodes];
};

template <int kNodes>
PALPATE_INLINE void GatherPositions(const Block& block, const double* x_m,
                                    Positions<kNodes>& positions) {
  for (int a = 0; a < kNodes; ++a) {
    for (int lane = 0; lane < kLanes; ++lane) {
      const double* x = x_m + 3 * static_cast<long>(block.nodes[a * kLanes + lane]);
      for (int i = 0; i < 3; ++i) positions.x[a].v[i][lane] = x[i];
    }
  }
}

template <int kNodes>
PALPATE_INLINE void LoadGradients(const Block& block, int point, Vec (&gradients)[kNodes]) {
  const double* source = block.gradients + static_cast<long>(point) * kNodes * 3 * kLanes;
  for (int a = 0; a < kNodes; ++a) {
    for (int i = 0; i < 3; ++i) gradients[a].v[i] = Load(source + (a * 3 + i) * kLanes);
  }
}

template <int kNodes>
PALPATE_INLINE Mat DeformationGradient(const Positions<kNodes>& positions,
                                       const Vec (&gradients)[kNodes]) {
  Mat F = Diagonal(Splat(0.0));
  for (int a = 0; a < kNodes; ++a) {
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) F.m[i][j] += positions.x[a].v[i] * gradients[a].v[j];
    }
  }
  return F;
}

/// det F, or 1 + tr(eps) for the linear law.
template <MaterialModel model>
PALPATE_INLINE Pack VolumeRatio(const Mat& F) {
  if constexpr (model == MaterialModel::kLinear) {
    return Trace(F) - 2.0;
  } else {
    return Determinant(F, Cofactor(F));
  }
}

template <MaterialModel model, bool kMean>
PALPATE_INLINE void EvaluatePoint(const VolumetricLaw& mean_law, Pack lambda, Pack mu,
                                  PointState& point) {
  if constexpr (HasVolumetricLaw(model)) {
    const VolumetricLaw law = kMean ? mean_law : EvaluateVolumetric<model>(point.J, lambda);
    if constexpr (IsJBased(model)) {
      EvaluateJBased<model>(law, !kMean, mu, point);
    } else {
      EvaluateLinear(law, !kMean, mu, point);
    }
    if constexpr (!kMean) point.energy += law.U;
  } else if constexpr (model == MaterialModel::kStVenantKirchhoff) {
    EvaluateStVenantKirchhoff(lambda, mu, point);
  } else {
    EvaluateCorotational(lambda, mu, point);
  }
}

PALPATE_INLINE void Accumulate(double* target, Pack value) { Store(target, Load(target) + value); }

/// Adds weight (s (G_a . G_b) I + A v_a v_b' + B v_b v_a' + own part) for every pair of nodes.
template <MaterialModel model, int kNodes>
PALPATE_INLINE void AddPointStiffness(const PointState& point, Pack weight,
                                      const Vec (&gradients)[kNodes], double* stiffness) {
  Vec v[kNodes];
  for (int a = 0; a < kNodes; ++a) v[a] = Times(point.node_map, gradients[a]);
  const Pack s = weight * point.s;
  const Pack A = weight * point.A;
  const Pack B = weight * point.B;
  for (int b = 0; b < kNodes; ++b) {
    Vec stressed = gradients[b];
    Mat spun = point.extra;
    if constexpr (model == MaterialModel::kStVenantKirchhoff) {
      stressed = Times(point.second, gradients[b]);
    } else if constexpr (model == MaterialModel::kCorotational) {
      const Pack zero = Splat(0.0);
      const Mat skew = {{{zero, -v[b].v[2], v[b].v[1]},
                         {v[b].v[2], zero, -v[b].v[0]},
                         {-v[b].v[1], v[b].v[0], zero}}};
      spun = Combine(weight * point.kappa, Times(point.extra, skew), zero, skew);
    }
    for (int a = b; a < kNodes; ++a) {
      const Pack dot = Dot(gradients[a], gradients[b]);
      Pack isotropic = s * dot;
      if constexpr (model == MaterialModel::kStVenantKirchhoff) {
        isotropic = weight * Dot(gradients[a], stressed);
      }
      double* target = stiffness + PairIndex(a, b) * 9 * kLanes;
      for (int i = 0; i < 3; ++i) {
        for (int k = 0; k < 3; ++k) {
          Pack value = A * v[a].v[i] * v[b].v[k] + B * v[b].v[i] * v[a].v[k];
          if constexpr (model == MaterialModel::kStVenantKirchhoff) {
            value += s * dot * point.extra.m[i][k];
          }
          if constexpr (model == MaterialModel::kCorotational) {
            // [v_a]_x' spun: minus the cross product of v_a with the columns of spun.
            const int i1 = (i + 1) % 3;
            const int i2 = (i + 2) % 3;
            value += v[a].v[i2] * spun.m[i1][k] - v[a].v[i1] * spun.m[i2][k];
          }
          if (i == k) value += isotropic;
          Accumulate(target + (i * 3 + k) * kLanes, value);
        }
      }
    }
  }
}

template <int kNodes>
PALPATE_INLINE void AddPointForce(const PointState& point, Pack weight,
                                  const Vec (&gradients)[kNodes], double* force) {
  for (int a = 0; a < kNodes; ++a) {
    const Vec f = Times(point.P, gradients[a]);
    for (int i = 0; i < 3; ++i) Accumulate(force + (a * 3 + i) * kLanes, weight * f.v[i]);
  }
}

/// Rank-one part of the mean-dilatation tangent: U'' / V C_a C_b', C_a = sum of w cof(F) G_a.
template <int kNodes>
PALPATE_INLINE void AddMeanStiffness(Pack coefficient, const Vec (&C)[kNodes], double* stiffness) {
  for (int b = 0; b < kNodes; ++b) {
    for (int a = b; a < kNodes; ++a) {
      double* target = stiffness + PairIndex(a, b) * 9 * kLanes;
      for (int i = 0; i < 3; ++i) {
        for (int k = 0; k < 3; ++k) {
          Accumulate(target + (i * 3 + k) * kLanes, coefficient * C[a].v[i] * C[b].v[k]);
        }
      }
    }
  }
}

template <MaterialModel model, int kNodes, int kPoints, bool kMean>
void EvaluateBlock(const Block& block, const double* x_m, const Output& output) {
  const Pack lambda = Load(block.lambda_Pa);
  const Pack mu = Load(block.mu_Pa);
  Positions<kNodes> positions;
  GatherPositions<kNodes>(block, x_m, positions);
  Vec gradients[kNodes];
  Vec C[kNodes] = {};
  Pack volume = Splat(0.0);
  VolumetricLaw mean_law = {};
  if constexpr (kMean) {
    Pack deformed_volume = Splat(0.0);
    for (int point = 0; point < kPoints; ++point) {
      LoadGradients<kNodes>(block, point, gradients);
      const Pack weight = Load(block.weights + point * kLanes);
      volume += weight;
      deformed_volume +=
          weight * VolumeRatio<model>(DeformationGradient<kNodes>(positions, gradients));
    }
    mean_law = EvaluateVolumetric<model>(deformed_volume / volume, lambda);
  }
  if (output.force) {
    for (int k = 0; k < kNodes * 3; ++k) Store(output.force + k * kLanes, Splat(0.0));
  }
  if (output.stiffness) {
    for (int k = 0; k < PairCount(kNodes) * 9; ++k) {
      Store(output.stiffness + k * kLanes, Splat(0.0));
    }
  }
  Pack energy = volume * mean_law.U;
  Pack min_J = Splat(__builtin_huge_val());
  for (int q = 0; q < kPoints; ++q) {
    LoadGradients<kNodes>(block, q, gradients);
    const Pack weight = Load(block.weights + q * kLanes);
    PointState point;
    point.F = DeformationGradient<kNodes>(positions, gradients);
    point.J = VolumeRatio<model>(point.F);
    EvaluatePoint<model, kMean>(mean_law, lambda, mu, point);
    min_J = Min(min_J, point.J);
    energy += weight * point.energy;
    if (output.force) AddPointForce<kNodes>(point, weight, gradients, output.force);
    if (output.stiffness) {
      AddPointStiffness<model, kNodes>(point, weight, gradients, output.stiffness);
      if constexpr (kMean) {
        for (int a = 0; a < kNodes; ++a) {
          const Vec c = Times(point.node_map, gradients[a]);
          for (int i = 0; i < 3; ++i) C[a].v[i] += weight * c.v[i];
        }
      }
    }
  }
  if constexpr (kMean) {
    if (output.stiffness) AddMeanStiffness<kNodes>(mean_law.ddU / volume, C, output.stiffness);
  }
  if (output.energy) Store(output.energy, energy);
  if (output.min_J) Store(output.min_J, min_J);
}

template <int kNodes, int kPoints>
Kernel SelectByMaterial(MaterialModel model, bool mean) {
  switch (model) {
    case MaterialModel::kLinear:
      return mean ? &EvaluateBlock<MaterialModel::kLinear, kNodes, kPoints, true>
                  : &EvaluateBlock<MaterialModel::kLinear, kNodes, kPoints, false>;
    case MaterialModel::kNeoHookean:
      return mean ? &EvaluateBlock<MaterialModel::kNeoHookean, kNodes, kPoints, true>
                  : &EvaluateBlock<MaterialModel::kNeoHookean, kNodes, kPoints, false>;
    case MaterialModel::kStableNeoHookean:
      return mean ? &EvaluateBlock<MaterialModel::kStableNeoHookean, kNodes, kPoints, true>
                  : &EvaluateBlock<MaterialModel::kStableNeoHookean, kNodes, kPoints, false>;
    case MaterialModel::kCorotational:
      return &EvaluateBlock<MaterialModel::kCorotational, kNodes, kPoints, false>;
    case MaterialModel::kStVenantKirchhoff:
      return &EvaluateBlock<MaterialModel::kStVenantKirchhoff, kNodes, kPoints, false>;
  }
  return nullptr;
}

Kernel SelectHere(int nodes_per_element, MaterialModel model, bool mean) {
  return nodes_per_element == 4 ? SelectByMaterial<4, 1>(model, false)
                                : SelectByMaterial<10, 4>(model, mean);
}

}  // namespace
