// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace palpate::fem::mesh_io {

/// The number types of binary mesh files.
enum class ScalarType {
  kInt8,
  kUInt8,
  kInt16,
  kUInt16,
  kInt32,
  kUInt32,
  kInt64,
  kUInt64,
  kFloat32,
  kFloat64
};

size_t SizeInBytes(ScalarType type);
bool IsInteger(ScalarType type);

/// The value at the start of `bytes` (at least SizeInBytes long), its bytes reversed where `swap`.
double DecodeReal(ScalarType type, std::string_view bytes, bool swap);
/// The same for integer types; empty for an unsigned value that no int64 holds.
std::optional<int64_t> DecodeInteger(ScalarType type, std::string_view bytes, bool swap);

/// The numbers of a whole array, as many as `values` has room for. Not finite ones stay as they
/// are; an unsigned value that no int64 holds becomes negative.
void DecodeReals(ScalarType type, std::string_view bytes, bool swap, std::span<double> values);
void DecodeIntegers(ScalarType type, std::string_view bytes, bool swap, std::span<int64_t> values);

}  // namespace palpate::fem::mesh_io
