// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "components/virtual_camera/kernels/kernels.hpp"

namespace palpate::virtual_camera::kernels {

/// One for each instruction set that the kernels are compiled for.
const Kernels& PortableKernels();
const Kernels& Avx2Kernels();
const Kernels& Avx512Kernels();

}  // namespace palpate::virtual_camera::kernels
