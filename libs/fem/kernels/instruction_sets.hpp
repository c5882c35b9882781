// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "libs/fem/kernels/kernel.hpp"

namespace palpate::fem::kernels {

/// One for each instruction set the element kernel is compiled for.
Kernel SelectPortable(int nodes_per_element, MaterialModel model, bool mean);
Kernel SelectAvx2(int nodes_per_element, MaterialModel model, bool mean);
Kernel SelectAvx512(int nodes_per_element, MaterialModel model, bool mean);

}  // namespace palpate::fem::kernels
