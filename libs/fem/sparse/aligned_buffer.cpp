// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/sparse/aligned_buffer.hpp"

#include <algorithm>
#include <limits>
#include <new>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace palpate::fem::internal {

template <typename Value>
AlignedBufferOf<Value>::AlignedBufferOf(size_t size) : size_(size) {
  constexpr size_t kLargePage = size_t{1} << 21;
  constexpr size_t kCacheLine = 64;
  const size_t unit = bytes() >= kLargePage ? kLargePage : kCacheLine;
  const size_t allocated = (bytes() + unit - 1) / unit * unit;
  if (allocated == 0) return;
  data_.reset(static_cast<Value*>(std::aligned_alloc(unit, allocated)));
  if (data_ == nullptr) throw std::bad_alloc();
#if defined(__linux__)
  // Advice only: where the system does not follow it, nothing but speed is lost.
  if (unit == kLargePage) static_cast<void>(madvise(data_.get(), allocated, MADV_HUGEPAGE));
#endif
  std::fill_n(data_.get(), allocated / sizeof(Value), std::numeric_limits<Value>::quiet_NaN());
}

template class AlignedBufferOf<double>;
template class AlignedBufferOf<float>;

}  // namespace palpate::fem::internal
