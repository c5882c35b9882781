// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

/// The element kernel: as many elements at a time as a register has lanes. Included by one source
/// for each instruction set.
#include "libs/fem/kernels/kernel.hpp"
#include "libs/fem/kernels/stiffness.inl"

namespace {

using palpate::fem::kernels::Block;
using palpate::fem::kernels::Kernel;
using palpate::fem::kernels::Output;

template <MaterialModel model, int kNodes, int kPoints>
PALPATE_INLINE void MeasureDeformation(const Vec (&x)[kNodes], const Gradients<kNodes>& gradients,
                                       const double* weights, Point (&points)[kPoints]) {
  for (int q = 0; q < kPoints; ++q) {
    Mat F = Diagonal(Splat(0.0));
    for (int a = 0; a < kNodes; ++a) {
      const Vec gradient = gradients.At(q, a);
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) F.m[i][j] += x[a].v[i] * gradient.v[j];
      }
    }
    Point& point = points[q];
    point.F = F;
    point.weight = Load(weights + q * kLanes);
    if constexpr (model == MaterialModel::kLinear) {
      point.J = Trace(F) - 2.0;  // 1 + tr(eps)
    } else {
      point.cofactor = Cofactor(F);
      point.J = Determinant(F, point.cofactor);
    }
  }
}

/// Internal forces sum of w P G_a.
template <int kNodes, int kPoints>
PALPATE_INLINE void AddForces(const Point (&points)[kPoints], const Gradients<kNodes>& gradients,
                              const int* force_rows, double* force) {
  Vec sum[kNodes] = {};
  for (int q = 0; q < kPoints; ++q) {
    const Mat P = Scale(points[q].weight, points[q].P);
    for (int a = 0; a < kNodes; ++a) {
      const Vec gradient = gradients.At(q, a);
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) sum[a].v[i] += P.m[i][j] * gradient.v[j];
      }
    }
  }
  const Pack zero = Splat(0.0);
  for (int a = 0; a < kNodes; a += 2) {
    const Vec& f = sum[a];
    const Vec& g = sum[a + 1];
    Row rows[kWidth];  // each with the forces of two nodes
    MakeRows({f.v[0], f.v[1], f.v[2], zero, g.v[0], g.v[1], g.v[2], zero}, rows);
    for (int lane = 0; lane < kWidth; ++lane) {
      AddHalfRows(rows[lane], force + 4 * static_cast<long>(force_rows[a * kLanes + lane]),
                  force + 4 * static_cast<long>(force_rows[(a + 1) * kLanes + lane]));
    }
  }
}

/// The lanes `lane` to `lane + kWidth - 1`.
template <MaterialModel model, int kNodes, int kPoints, bool kMean>
PALPATE_INLINE void EvaluateLanes(const Block& block, int lane, const double* x_m,
                                  const Output& output) {
  const Moduli moduli{Load(block.lambda_Pa + lane), Load(block.mu_Pa + lane),
                      Load(block.c20_over_c10 + lane), Load(block.c30_over_c10 + lane)};
  const Gradients<kNodes> gradients{block.gradients + lane};
  Vec x[kNodes];
  for (int a = 0; a < kNodes; ++a) x[a] = GatherNode(x_m, block.nodes + a * kLanes + lane);
  Point points[kPoints];
  MeasureDeformation<model, kNodes, kPoints>(x, gradients, block.weights + lane, points);

  Pack volume = Splat(0.0);
  VolumetricLaw mean_law = {};
  if constexpr (kMean) {
    Pack deformed_volume = Splat(0.0);
    for (const Point& point : points) {
      volume += point.weight;
      deformed_volume += point.weight * point.J;
    }
    // mu times the volumetric energy resists the change of volume within the element.
    mean_law = EvaluateVolumetric<model>(deformed_volume / volume, moduli.lambda - moduli.mu);
  }
  Pack energy = volume * mean_law.U;
  Pack min_J = points[0].J;
  for (Point& point : points) {
    VolumetricLaw law = {};
    if constexpr (Traits<model>::kVolumetric) {
      law = EvaluateVolumetric<model>(point.J, kMean ? moduli.mu : moduli.lambda);
      law.dU += mean_law.dU;  // zero where !kMean
    }
    EvaluateLaw<model>(law, moduli, output.energy != nullptr, point);
    energy += point.weight * point.energy;
    min_J = Min(point.J, min_J);
  }
  if (output.energy) Store(output.energy + lane, energy);
  if (output.min_J) Store(output.min_J + lane, min_J);
  if (output.force) {
    AddForces<kNodes, kPoints>(points, gradients, output.force_rows + lane, output.force);
  }
  if (output.stiffness) {
    AddStiffness<model, kNodes, kPoints, kMean>(points, gradients, mean_law.ddU / volume,
                                                output.addresses + lane, output.stiffness);
  }
}

template <MaterialModel model, int kNodes, int kPoints, bool kMean>
void EvaluateBlock(const Block& block, const double* x_m, const Output& output) {
  for (int lane = 0; lane < kLanes; lane += kWidth) {
    EvaluateLanes<model, kNodes, kPoints, kMean>(block, lane, x_m, output);
  }
}

template <MaterialModel model>
Kernel SelectByElement(int nodes_per_element, bool mean) {
  if (nodes_per_element == 4) return &EvaluateBlock<model, 4, 1, false>;
  if constexpr (Traits<model>::kVolumetric) {
    if (mean) return &EvaluateBlock<model, 10, 4, true>;
  }
  return &EvaluateBlock<model, 10, 4, false>;
}

Kernel SelectHere(int nodes_per_element, MaterialModel model, bool mean) {
  switch (model) {
    case MaterialModel::kLinear:
      return SelectByElement<MaterialModel::kLinear>(nodes_per_element, mean);
    case MaterialModel::kCorotational:
      return SelectByElement<MaterialModel::kCorotational>(nodes_per_element, mean);
    case MaterialModel::kStVenantKirchhoff:
      return SelectByElement<MaterialModel::kStVenantKirchhoff>(nodes_per_element, mean);
    case MaterialModel::kNeoHookean:
      return SelectByElement<MaterialModel::kNeoHookean>(nodes_per_element, mean);
    case MaterialModel::kStableNeoHookean:
      return SelectByElement<MaterialModel::kStableNeoHookean>(nodes_per_element, mean);
    case MaterialModel::kYeoh:
      return SelectByElement<MaterialModel::kYeoh>(nodes_per_element, mean);
  }
  return nullptr;
}

}  // namespace
