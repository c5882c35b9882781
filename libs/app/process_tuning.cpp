// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/app/process_tuning.hpp"

#include <malloc.h>

namespace palpate::app {

namespace {

/// Larger blocks of memory go back to the system at once; glibc's limit for the first is 32 MB.
constexpr int kReusedBytes = 32 << 20;

}  // namespace

void KeepLargeBlocks() {
  mallopt(M_MMAP_THRESHOLD, kReusedBytes);
  mallopt(M_TRIM_THRESHOLD, kReusedBytes);
}

}  // namespace palpate::app
