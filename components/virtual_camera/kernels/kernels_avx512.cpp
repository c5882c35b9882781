// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/virtual_camera/kernels/instruction_sets.hpp"
#include "components/virtual_camera/kernels/table.inl"

namespace palpate::virtual_camera::kernels {

const Kernels& Avx512Kernels() { return kTable; }

}  // namespace palpate::virtual_camera::kernels
