// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/kernels/kernel.hpp"

#include "libs/core/check.hpp"
#include "libs/fem/kernels/instruction_sets.hpp"

namespace palpate::fem::kernels {

namespace {

enum class Isa { kPortable, kAvx2, kAvx512 };

Isa DetectIsa() {
#if defined(PALPATE_X86_KERNELS)
  if (__builtin_cpu_supports("avx512f")) return Isa::kAvx512;
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return Isa::kAvx2;
#endif
  return Isa::kPortable;
}

Isa ActiveIsa() {
  static const Isa isa = DetectIsa();
  return isa;
}

}  // namespace

bool SupportsMeanDilatation(MaterialModel model) {
  return model == MaterialModel::kLinear || model == MaterialModel::kNeoHookean ||
         model == MaterialModel::kStableNeoHookean;
}

Kernel SelectKernel(int nodes_per_element, MaterialModel model, Volumetric volumetric) {
  PALPATE_CHECK(nodes_per_element == 4 || nodes_per_element == 10, nodes_per_element);
  const bool mean = volumetric == Volumetric::kMeanDilatation;
  PALPATE_CHECK(!mean || SupportsMeanDilatation(model), ToString(model));
#if defined(PALPATE_X86_KERNELS)
  if (ActiveIsa() == Isa::kAvx512) return SelectAvx512(nodes_per_element, model, mean);
  if (ActiveIsa() == Isa::kAvx2) return SelectAvx2(nodes_per_element, model, mean);
#endif
  return SelectPortable(nodes_per_element, model, mean);
}

const char* InstructionSet() {
  switch (ActiveIsa()) {
    case Isa::kAvx512: return "avx512";
    case Isa::kAvx2: return "avx2";
    case Isa::kPortable: return "portable";
  }
  return "";
}

}  // namespace palpate::fem::kernels
