// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "libs/fem/sparse/dense/front_kernels.hpp"

namespace palpate::fem::dense {

const FrontKernels& FrontKernelsPortable();
const FrontKernels& FrontKernelsAvx2();
const FrontKernels& FrontKernelsAvx512();

}  // namespace palpate::fem::dense
