// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/sparse/dense/front_kernels.hpp"

#include "libs/fem/sparse/dense/front_kernels_sets.hpp"

namespace palpate::fem::dense {

const FrontKernels& SelectFrontKernels(InstructionSet set) {
#if defined(PALPATE_X86_KERNELS)
  if (set == InstructionSet::kAvx512) return FrontKernelsAvx512();
  if (set == InstructionSet::kAvx2) return FrontKernelsAvx2();
#endif
  static_cast<void>(set);
  return FrontKernelsPortable();
}

}  // namespace palpate::fem::dense
