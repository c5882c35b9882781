// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "libs/fem/material.hpp"

/// Element integrals, eight elements at a time. Plain memory in and out, so that the same source is
/// compiled for several instruction sets without a shared inline function leaking from one to the
/// other; the set is chosen at run time.
namespace palpate::fem::kernels {

/// Elements in one block; all arrays below have the lane as their last index.
inline constexpr int kLanes = 8;

/// A block of elements of one type and one material model. Arrays are contiguous.
struct Block {
  const int* nodes;         ///< [nodes_per_element][kLanes] node indices
  const double* gradients;  ///< [points][nodes_per_element][3][kLanes] dN/dX, 1/m
  const double* weights;    ///< [points][kLanes] rest volume of each integration point, m^3
  const double* lambda_Pa;  ///< [kLanes] first Lame constant
  const double* mu_Pa;      ///< [kLanes] second Lame constant
};

/// What one evaluation writes. Each pointer may be null where it is not wanted.
struct Output {
  double* force;      ///< [nodes_per_element][3][kLanes] internal forces, N
  double* stiffness;  ///< [pairs][3][3][kLanes] dforce_a/dx_b for the pairs (a, b), b <= a, N/m
  double* energy;     ///< [kLanes] J
  double* min_J;      ///< [kLanes] smallest det F over the integration points
};

/// Evaluates one block at the node positions x_m [3n].
using Kernel = void (*)(const Block& block, const double* x_m, const Output& output);

/// Position of the pair (a, b), b <= a, in Output::stiffness.
constexpr int PairIndex(int a, int b) { return a * (a + 1) / 2 + b; }
constexpr int PairCount(int nodes_per_element) {
  return nodes_per_element * (nodes_per_element + 1) / 2;
}

/// The kernel for this element (4 or 10 nodes), material and processor. Never null for the
/// combinations of MaterialModel and Volumetric that SupportsMeanDilatation allows.
Kernel SelectKernel(int nodes_per_element, MaterialModel model, Volumetric volumetric);

/// Models whose volumetric energy depends on the volume change alone.
bool SupportsMeanDilatation(MaterialModel model);

/// Instruction set in use: "avx512", "avx2" or "portable".
const char* InstructionSet();

}  // namespace palpate::fem::kernels
