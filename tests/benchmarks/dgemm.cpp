// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/benchmarks/dgemm.hpp"

#include <cstddef>

// NOLINTNEXTLINE(readability-identifier-naming): the BLAS's own name
extern "C" void dgemm_(const char* transpose_a, const char* transpose_b, const int* rows,
                       const int* columns, const int* inner, const double* alpha, const double* a,
                       const int* stride_a, const double* b, const int* stride_b,
                       const double* beta, double* c, const int* stride_c);

namespace palpate::benchmarks {

Dgemm::Dgemm(int size)
    : size_(size),
      a_(static_cast<size_t>(size) * static_cast<size_t>(size), 0.5),
      b_(a_.size(), 0.25),
      product_(a_.size(), 0.0) {}

void Dgemm::Multiply() {
  const double one = 1.0;
  const double zero = 0.0;
  dgemm_("N", "N", &size_, &size_, &size_, &one, a_.data(), &size_, b_.data(), &size_, &zero,
         product_.data(), &size_);
}

}  // namespace palpate::benchmarks
