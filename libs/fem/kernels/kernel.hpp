// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "libs/fem/material.hpp"

/// Element integrals, eight elements at a time, and their way into forces and stiffness matrix.
/// Plain memory in and out, so that the same source is compiled for several instruction sets
/// without a shared inline function leaking from one to the other; the set is chosen at run time.
namespace palpate::fem::kernels {

/// Elements in one block; all arrays below have the lane as their last index.
inline constexpr int kLanes = 8;

/// A block of elements of one type and one material model. Arrays are contiguous.
struct Block {
  const int* nodes;            ///< [nodes_per_element][kLanes] node indices
  const double* gradients;     ///< [points][nodes_per_element][3][kLanes] dN/dX, 1/m
  const double* weights;       ///< [points][kLanes] rest volume of each integration point, m^3
  const double* lambda_Pa;     ///< [kLanes] first Lame constant
  const double* mu_Pa;         ///< [kLanes] second Lame constant
  const double* c20_over_c10;  ///< [kLanes] of the Yeoh material
  const double* c30_over_c10;  ///< [kLanes]
};

/// Position of the pair (a, b), b <= a, among the pairs of an element's nodes: column after column.
constexpr int PairIndex(int a, int b, int nodes_per_element) {
  return b * nodes_per_element - b * (b - 1) / 2 + a - b;
}
constexpr int PairCount(int nodes_per_element) {
  return nodes_per_element * (nodes_per_element + 1) / 2;
}

/// What one evaluation gives. Pointers may be null where something is not wanted.
struct Output {
  double* force = nullptr;  ///< [rows][4], to which internal forces (x, y, z, 0), N, are added
  const int* force_rows = nullptr;  ///< [nodes_per_element][kLanes] of `force`
  /// 3x3 blocks of nine doubles, column by column, N/m, to which dforce_a/dx_b is added.
  double* stiffness = nullptr;
  /// [pairs][kLanes], for the pairs (a, b) by PairIndex: the first entry's place in `stiffness`;
  /// negative: nowhere.
  const int* addresses = nullptr;
  double* energy = nullptr;  ///< [kLanes], overwritten, J
  double* min_J = nullptr;   ///< [kLanes], overwritten, smallest det F of the integration points
};

/// Evaluates one block at the node positions x_m [3n]. What a lane gives does not depend on the
/// other lanes, and the order of additions only on the block.
using Kernel = void (*)(const Block& block, const double* x_m, const Output& output);

/// The kernel for this element (4 or 10 nodes), material and processor. Never null for the
/// combinations of MaterialModel and Volumetric that SupportsMeanDilatation allows.
Kernel SelectKernel(int nodes_per_element, MaterialModel model, Volumetric volumetric);

/// Models whose volumetric energy depends on the volume change alone.
bool SupportsMeanDilatation(MaterialModel model);

/// Instruction set in use: "avx512", "avx2" or "portable".
const char* InstructionSet();

}  // namespace palpate::fem::kernels
