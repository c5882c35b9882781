// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/kernels/kernel.hpp"

#include "libs/core/check.hpp"
#include "libs/core/instruction_set.hpp"
#include "libs/fem/kernels/instruction_sets.hpp"

namespace palpate::fem::kernels {

bool SupportsMeanDilatation(MaterialModel model) {
  return model != MaterialModel::kCorotational && model != MaterialModel::kStVenantKirchhoff;
}

Kernel SelectKernel(int nodes_per_element, MaterialModel model, Volumetric volumetric) {
  PALPATE_CHECK(nodes_per_element == 4 || nodes_per_element == 10, nodes_per_element);
  const bool mean = volumetric == Volumetric::kMeanDilatation;
  PALPATE_CHECK(!mean || SupportsMeanDilatation(model), ToString(model));
#if defined(PALPATE_X86_KERNELS)
  using Set = palpate::InstructionSet;
  const Set set = BestInstructionSet();
  if (set == Set::kAvx512) return SelectAvx512(nodes_per_element, model, mean);
  if (set == Set::kAvx2) return SelectAvx2(nodes_per_element, model, mean);
#endif
  return SelectPortable(nodes_per_element, model, mean);
}

const char* InstructionSet() { return ToString(BestInstructionSet()).data(); }

}  // namespace palpate::fem::kernels
