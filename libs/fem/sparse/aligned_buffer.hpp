// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstddef>
#include <cstdlib>
#include <memory>

namespace palpate::fem::internal {

/// Numbers at the start of a cache line, large buffers at that of a page of 2 MiB: they ask the
/// system for such pages, because columns far apart would miss the address cache otherwise. NaN at
/// first: what is read before it was written shows, and the memory is the program's from here on.
template <typename Value>
class AlignedBufferOf {
 public:
  AlignedBufferOf() = default;
  explicit AlignedBufferOf(size_t size);  ///< std::bad_alloc where there is no memory

  Value* data() { return data_.get(); }
  const Value* data() const { return data_.get(); }
  size_t size() const { return size_; }
  size_t bytes() const { return size_ * sizeof(Value); }

 private:
  struct Free {
    void operator()(Value* pointer) const { std::free(pointer); }
  };
  std::unique_ptr<Value[], Free> data_;
  size_t size_ = 0;
};

using AlignedBuffer = AlignedBufferOf<double>;

extern template class AlignedBufferOf<double>;
extern template class AlignedBufferOf<float>;

}  // namespace palpate::fem::internal
