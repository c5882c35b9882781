// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstddef>

namespace palpate::force_estimation {

/// Requests for heap memory by this program so far: malloc and its kin, operator new. Those that
/// OpenBLAS and the OpenMP run time make inside CHOLMOD's factorisation (scratch and thread teams)
/// are left out: nothing of ours keeps them from it.
size_t HeapRequestCount();

/// Whether they are counted: not where a sanitizer has its own malloc.
bool HeapRequestsAreCounted();

}  // namespace palpate::force_estimation
