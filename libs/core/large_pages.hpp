// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstddef>
#include <new>
#include <utility>
#include <vector>

namespace palpate {

/// Asks the system to map memory that is reserved and not yet written in large pages where it has
/// them: the first write to each small page costs more than the copy into it. Any address and size.
void AdviseLargePages(const void* begin, std::size_t size_bytes);

/// The same for the room of a std::vector or std::string.
template <typename Container>
void AdviseLargePages(const Container& container) {
  AdviseLargePages(container.data(), container.capacity() * sizeof(typename Container::value_type));
}

/// For vectors of millions of numbers that are written once: large pages, and numbers that are not
/// set where none is given.
template <typename T>
struct LargeAllocator {
  using value_type = T;
  LargeAllocator() = default;
  template <typename U>
  explicit LargeAllocator(const LargeAllocator<U>& /*other*/) {}

  T* allocate(std::size_t count) {
    const std::size_t size_bytes = count * sizeof(T);
    void* room = ::operator new(size_bytes, AlignmentFor(count));
    AdviseLargePages(room, size_bytes);
    return static_cast<T*>(room);
  }
  void deallocate(T* room, std::size_t count) { ::operator delete(room, AlignmentFor(count)); }

  template <typename U, typename... Values>
  void construct(U* place, Values&&... values) {
    if constexpr (sizeof...(Values) == 0) {
      ::new (static_cast<void*>(place)) U;
    } else {
      ::new (static_cast<void*>(place)) U(std::forward<Values>(values)...);
    }
  }
  bool operator==(const LargeAllocator&) const = default;

 private:
  static std::align_val_t AlignmentFor(std::size_t count) {
    constexpr std::size_t kLargePage = std::size_t{1} << 21;
    return std::align_val_t{count * sizeof(T) < 2 * kLargePage ? alignof(T) : kLargePage};
  }
};

template <typename T>
using LargeVector = std::vector<T, LargeAllocator<T>>;

}  // namespace palpate
