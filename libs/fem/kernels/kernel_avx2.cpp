// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/kernels/element_kernel.inl"
#include "libs/fem/kernels/instruction_sets.hpp"

namespace palpate::fem::kernels {

Kernel SelectAvx2(int nodes_per_element, MaterialModel model, bool mean) {
  return SelectHere(nodes_per_element, model, mean);
}

}  // namespace palpate::fem::kernels
