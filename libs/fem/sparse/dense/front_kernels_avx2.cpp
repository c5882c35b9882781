// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#define PALPATE_LANES 4
#define PALPATE_ACCUMULATORS 8
#include "libs/fem/sparse/dense/front_kernels.inl"
#include "libs/fem/sparse/dense/front_kernels_sets.hpp"

namespace palpate::fem::dense {

const FrontKernels& FrontKernelsAvx2() { return kKernels; }

}  // namespace palpate::fem::dense
