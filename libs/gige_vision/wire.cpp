// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/gige_vision/wire.hpp"

#include <algorithm>
#include <bit>

#include "libs/core/check.hpp"

namespace palpate::gige_vision {
namespace {

std::uint64_t Get(ByteView bytes, std::size_t at, std::size_t count) {
  PALPATE_CHECK(at + count <= bytes.size(), at, count, bytes.size());
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < count; ++i) value = (value << 8) | bytes[at + i];
  return value;
}

void Put(Bytes* bytes, std::uint64_t value, int count) {
  for (int i = count - 1; i >= 0; --i) {
    bytes->push_back(static_cast<std::uint8_t>(value >> (8 * i)));
  }
}

}  // namespace

std::uint16_t Get16(ByteView bytes, std::size_t at) {
  return static_cast<std::uint16_t>(Get(bytes, at, 2));
}

std::uint32_t Get32(ByteView bytes, std::size_t at) {
  return static_cast<std::uint32_t>(Get(bytes, at, 4));
}

std::uint64_t Get64(ByteView bytes, std::size_t at) { return Get(bytes, at, 8); }

void Put16(Bytes* bytes, std::uint16_t value) { Put(bytes, value, 2); }
void Put32(Bytes* bytes, std::uint32_t value) { Put(bytes, value, 4); }
void Put64(Bytes* bytes, std::uint64_t value) { Put(bytes, value, 8); }

Bytes Encode32(std::uint32_t value) {
  Bytes bytes;
  Put32(&bytes, value);
  return bytes;
}

Bytes Encode64(std::uint64_t value) {
  Bytes bytes;
  Put64(&bytes, value);
  return bytes;
}

Bytes EncodeDouble(double value) { return Encode64(std::bit_cast<std::uint64_t>(value)); }

Bytes EncodeText(std::string_view text, std::size_t length) {
  const std::string_view kept = text.substr(0, length - 1);
  Bytes bytes(kept.begin(), kept.end());
  bytes.resize(length);
  return bytes;
}

double DecodeDouble(ByteView bytes) { return std::bit_cast<double>(Get64(bytes, 0)); }

}  // namespace palpate::gige_vision
