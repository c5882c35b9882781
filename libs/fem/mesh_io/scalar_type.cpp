// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/mesh_io/scalar_type.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>

#include "libs/core/check.hpp"

namespace palpate::fem::mesh_io {

namespace {

template <typename Value>
Value Load(std::string_view bytes, bool swap) {
  std::array<char, sizeof(Value)> raw;
  std::memcpy(raw.data(), bytes.data(), raw.size());
  if (swap) std::reverse(raw.begin(), raw.end());
  Value value;
  std::memcpy(&value, raw.data(), raw.size());
  return value;
}

/// Calls `use` with a null value of the type.
template <typename Use>
auto WithType(ScalarType type, Use use) {
  switch (type) {
    case ScalarType::kInt8: return use(int8_t{});
    case ScalarType::kUInt8: return use(uint8_t{});
    case ScalarType::kInt16: return use(int16_t{});
    case ScalarType::kUInt16: return use(uint16_t{});
    case ScalarType::kInt32: return use(int32_t{});
    case ScalarType::kUInt32: return use(uint32_t{});
    case ScalarType::kInt64: return use(int64_t{});
    case ScalarType::kUInt64: return use(uint64_t{});
    case ScalarType::kFloat32: return use(float{});
    case ScalarType::kFloat64: break;
  }
  return use(double{});
}

/// The first value in its own type, handed to `use`.
template <typename Use>
auto Visit(ScalarType type, std::string_view bytes, bool swap, Use use) {
  PALPATE_CHECK(bytes.size() >= SizeInBytes(type), bytes.size());
  return WithType(type, [&](auto null) { return use(Load<decltype(null)>(bytes, swap)); });
}

template <typename Value>
void DecodeAll(ScalarType type, std::string_view bytes, bool swap, std::span<Value> values) {
  PALPATE_CHECK(bytes.size() / SizeInBytes(type) >= values.size(), bytes.size());
  WithType(type, [&](auto null) {
    using Stored = decltype(null);
    const char* from = bytes.data();
    for (Value& value : values) {
      value = static_cast<Value>(Load<Stored>({from, sizeof(Stored)}, swap));
      from += sizeof(Stored);
    }
  });
}

}  // namespace

size_t SizeInBytes(ScalarType type) {
  switch (type) {
    case ScalarType::kInt8:
    case ScalarType::kUInt8: return 1;
    case ScalarType::kInt16:
    case ScalarType::kUInt16: return 2;
    case ScalarType::kInt32:
    case ScalarType::kUInt32:
    case ScalarType::kFloat32: return 4;
    case ScalarType::kInt64:
    case ScalarType::kUInt64:
    case ScalarType::kFloat64: break;
  }
  return 8;
}

bool IsInteger(ScalarType type) {
  return type != ScalarType::kFloat32 && type != ScalarType::kFloat64;
}

double DecodeReal(ScalarType type, std::string_view bytes, bool swap) {
  return Visit(type, bytes, swap, [](auto value) { return static_cast<double>(value); });
}

std::optional<int64_t> DecodeInteger(ScalarType type, std::string_view bytes, bool swap) {
  PALPATE_CHECK(IsInteger(type));
  if (type == ScalarType::kUInt64) {
    const uint64_t value = Load<uint64_t>(bytes, swap);
    if (value > static_cast<uint64_t>(std::numeric_limits<int64_t>::max())) return std::nullopt;
    return static_cast<int64_t>(value);
  }
  return Visit(type, bytes, swap, [](auto value) { return static_cast<int64_t>(value); });
}

void DecodeReals(ScalarType type, std::string_view bytes, bool swap, std::span<double> values) {
  DecodeAll(type, bytes, swap, values);
}

void DecodeIntegers(ScalarType type, std::string_view bytes, bool swap, std::span<int64_t> values) {
  PALPATE_CHECK(IsInteger(type));
  DecodeAll(type, bytes, swap, values);
}

}  // namespace palpate::fem::mesh_io
