// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/experiment/c3d/c3d_bytes.hpp"

#include <bit>
#include <cmath>

#include "libs/core/error.hpp"
#include "libs/core/file.hpp"

namespace palpate::experiment {

namespace {

// VAX F: sign, 8 bits of exponent (excess 128), 23 bits of a mantissa 0.1...; a zero exponent is 0.
double RealFromVaxF(std::uint32_t bits) {
  const int exponent = static_cast<int>((bits >> 23) & 0xff);
  if (exponent == 0) return 0.0;
  const double mantissa = 0.5 + static_cast<double>(bits & 0x7fffff) / 16777216.0;
  const double magnitude = std::ldexp(mantissa, exponent - 128);
  return (bits >> 31) != 0 ? -magnitude : magnitude;
}

}  // namespace

C3dBytes::C3dBytes(const std::filesystem::path& file)
    : file_(file.string()), bytes_(ReadFile(file)) {}

void C3dBytes::Refuse(std::size_t offset, const std::string& message) const {
  throw InputError(SourceLocation{file_}, "at byte " + std::to_string(offset) + ": " + message);
}

void C3dBytes::Require(std::size_t offset, std::size_t count, std::string_view what) const {
  if (offset <= size() && count <= size() - offset) return;
  Refuse(offset, "the file ends at byte " + std::to_string(size()) + ", but " + std::string(what) +
                     " needs " + std::to_string(count) + " bytes here");
}

std::uint8_t C3dBytes::Byte(std::size_t offset) const {
  Require(offset, 1, "a value");
  return static_cast<std::uint8_t>(bytes_[offset]);
}

std::int8_t C3dBytes::SignedByte(std::size_t offset) const {
  return static_cast<std::int8_t>(Byte(offset));
}

std::uint16_t C3dBytes::Uint16(std::size_t offset) const {
  Require(offset, 2, "a value");
  const unsigned first = Byte(offset);
  const unsigned second = Byte(offset + 1);
  const bool big_endian = processor_ == C3dProcessor::kMips;
  return static_cast<std::uint16_t>(big_endian ? (first << 8) | second : (second << 8) | first);
}

std::int16_t C3dBytes::Int16(std::size_t offset) const {
  return static_cast<std::int16_t>(Uint16(offset));
}

double C3dBytes::Real(std::size_t offset) const {
  Require(offset, 4, "a real number");
  const std::uint32_t first = Uint16(offset);
  const std::uint32_t second = Uint16(offset + 2);
  if (processor_ == C3dProcessor::kDec) return RealFromVaxF((first << 16) | second);
  const bool big_endian = processor_ == C3dProcessor::kMips;
  const std::uint32_t bits = big_endian ? (first << 16) | second : (second << 16) | first;
  return static_cast<double>(std::bit_cast<float>(bits));
}

std::string_view C3dBytes::Text(std::size_t offset, std::size_t count) const {
  Require(offset, count, "a text");
  return std::string_view(bytes_).substr(offset, count);
}

}  // namespace palpate::experiment
