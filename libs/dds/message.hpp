// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <dds/dds.h>

#include <cstdint>
#include <cstring>
#include <string_view>
#include <utility>

#include "idl/message_traits.hpp"
#include "libs/core/check.hpp"

namespace palpate::dds {

/// Owns one message struct of the C mapping with all texts and sequences in it (filled with the
/// functions below). Starts as all zeros: numbers 0, texts and sequences empty.
template <typename T>
class Message {
 public:
  Message() = default;
  Message(Message&& other) noexcept : value_(std::exchange(other.value_, T{})) {}
  Message& operator=(Message&& other) noexcept {
    std::swap(value_, other.value_);
    return *this;
  }
  ~Message() { dds_sample_free(&value_, &idl::MessageTraits<T>::Descriptor(), DDS_FREE_CONTENTS); }

  T& operator*() { return value_; }
  const T& operator*() const { return value_; }
  T* operator->() { return &value_; }
  const T* operator->() const { return &value_; }

 private:
  T value_{};
};

/// Sets a text field to a copy of `text`.
inline void SetText(char*& field, std::string_view text) {
  dds_string_free(field);
  field = dds_string_alloc(text.size());
  if (!text.empty()) std::memcpy(field, text.data(), text.size());
  field[text.size()] = '\0';
}

/// The text of a field, empty where it was never set.
inline std::string_view Text(const char* field) { return field ? field : std::string_view(); }

/// Gives an empty sequence field `size` elements of all zeros.
template <typename Sequence>
void Resize(Sequence& sequence, size_t size) {
  PALPATE_CHECK(sequence._buffer == nullptr, sequence._length);
  PALPATE_CHECK(size <= UINT32_MAX, size);
  if (size == 0) return;
  const size_t bytes = size * sizeof(*sequence._buffer);
  void* buffer = dds_alloc(bytes);
  std::memset(buffer, 0, bytes);
  sequence._buffer = static_cast<decltype(sequence._buffer)>(buffer);
  sequence._length = sequence._maximum = static_cast<uint32_t>(size);
  sequence._release = true;
}

/// Fills an empty sequence field with numbers, converted one by one.
template <typename Sequence, typename Number>
void SetNumbers(Sequence& sequence, const Number* numbers, size_t size) {
  Resize(sequence, size);
  for (size_t i = 0; i < size; ++i) {
    sequence._buffer[i] =
        static_cast<std::remove_pointer_t<decltype(sequence._buffer)>>(numbers[i]);
  }
}

/// The elements of a sequence field, for range-for.
template <typename Sequence>
auto Elements(Sequence& sequence) {
  struct Range {
    decltype(sequence._buffer) first, last;
    auto begin() const { return first; }
    auto end() const { return last; }
  };
  return Range{sequence._buffer, sequence._buffer + sequence._length};
}

}  // namespace palpate::dds
