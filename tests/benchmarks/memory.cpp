// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/benchmarks/memory.hpp"

#include <sys/resource.h>

namespace palpate::benchmarks {

double PeakResidentBytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * static_cast<double>(usage.ru_maxrss);  // Linux counts it in KiB
}

}  // namespace palpate::benchmarks
