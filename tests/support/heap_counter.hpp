// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstddef>

namespace palpate::test_support {

/// Requests for heap memory by this program so far: malloc and its kin, operator new. Those that
/// OpenBLAS makes inside one of its functions are left out: its small AVX-512 products take some
/// hundred bytes of scratch from malloc at each call, and nothing but another processor type
/// (OPENBLAS_CORETYPE) keeps it from that.
size_t HeapRequestCount();

/// Whether they are counted: not where a sanitizer has its own malloc.
bool HeapRequestsAreCounted();

}  // namespace palpate::test_support
