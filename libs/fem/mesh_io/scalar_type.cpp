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

/// Calls `use` with the value in its own type.
template <typename Use>
auto Visit(ScalarType type, std::string_view bytes, bool swap, Use use) {
  PALPATE_CHECK(bytes.size() >= SizeInBytes(type), bytes.size());
  switch (type) {
    case ScalarType::kInt8: return use(Load<int8_t>(bytes, swap));
    case ScalarType::kUInt8: return use(Load<uint8_t>(bytes, swap));
    case ScalarType::kInt16: return use(Load<int16_t>(bytes, swap));
    case ScalarType::kUInt16: return use(Load<uint16_t>(bytes, swap));
    case ScalarType::kInt32: return use(Load<int32_t>(bytes, swap));
    case ScalarType::kUInt32: return use(Load<uint32_t>(bytes, swap));
    case ScalarType::kInt64: return use(Load<int64_t>(bytes, swap));
    case ScalarType::kUInt64: return use(Load<uint64_t>(bytes, swap));
    case ScalarType::kFloat32: return use(Load<float>(bytes, swap));
    case ScalarType::kFloat64: break;
  }
  return use(Load<double>(bytes, swap));
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

}  // namespace palpate::fem::mesh_io
