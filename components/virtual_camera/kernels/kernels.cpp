// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/virtual_camera/kernels/kernels.hpp"

#include "components/virtual_camera/kernels/instruction_sets.hpp"
#include "libs/core/instruction_set.hpp"

namespace palpate::virtual_camera::kernels {

namespace {

const Kernels& Of(InstructionSet set) {
#if defined(PALPATE_X86_KERNELS)
  if (set == InstructionSet::kAvx512) return Avx512Kernels();
  if (set == InstructionSet::kAvx2) return Avx2Kernels();
#endif
  static_cast<void>(set);
  return PortableKernels();
}

}  // namespace

const Kernels& BestKernels() { return Of(BestInstructionSet()); }

const Kernels* KernelsOf(std::string_view instruction_set) {
  for (const InstructionSet set : AvailableInstructionSets()) {
    if (ToString(set) == instruction_set) return &Of(set);
  }
  return nullptr;
}

}  // namespace palpate::virtual_camera::kernels
