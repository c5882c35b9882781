// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/experiment/cloud/scalar.hpp"

#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>

namespace palpate::experiment {

namespace {

double FromBits(std::uint64_t bits, const Scalar& scalar) {
  if (scalar.kind == Scalar::Kind::kFloat) {
    return scalar.bytes == 4
               ? static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(bits)))
               : std::bit_cast<double>(bits);
  }
  if (scalar.kind == Scalar::Kind::kUnsigned) return static_cast<double>(bits);
  const auto unused_bits = static_cast<int>(8 * (8 - scalar.bytes));
  return static_cast<double>(static_cast<std::int64_t>(bits << unused_bits) >> unused_bits);
}

bool IsBlank(char c) { return c == ' ' || c == '\t'; }

}  // namespace

bool Scalar::IsSound() const {
  if (kind == Kind::kFloat) return bytes == 4 || bytes == 8;
  return bytes == 1 || bytes == 2 || bytes == 4 || bytes == 8;
}

std::uint64_t Scalar::LoadBits(const char* data, ByteOrder order) const {
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < bytes; ++i) {
    const std::size_t place = order == ByteOrder::kBig ? i : bytes - 1 - i;
    bits = (bits << 8) | static_cast<unsigned char>(data[place]);
  }
  return bits;
}

double Scalar::Load(const char* data, ByteOrder order) const {
  return FromBits(LoadBits(data, order), *this);
}

bool Scalar::Parse(std::string_view text, double* value) const {
  if (text.starts_with('+')) text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), *value);
  // A number too small for a double is zero: packed colours written as floats are such numbers.
  const bool small = error == std::errc::result_out_of_range && std::abs(*value) < 1.0;
  if (small) *value = 0.0;
  return (error == std::errc() || small) && end == text.data() + text.size() && !text.empty();
}

std::uint64_t Scalar::BitsOf(double value) const {
  if (kind == Kind::kFloat) {
    return bytes == 4 ? std::bit_cast<std::uint32_t>(static_cast<float>(value))
                      : std::bit_cast<std::uint64_t>(value);
  }
  if (!(std::abs(value) < 9e18)) return 0;
  return static_cast<std::uint64_t>(static_cast<std::int64_t>(value));
}

void AppendLittleEndian(std::uint32_t value, std::string* bytes) {
  for (int i = 0; i < 4; ++i) bytes->push_back(static_cast<char>(value >> (8 * i) & 0xff));
}

void AppendLittleEndian(float value, std::string* bytes) {
  AppendLittleEndian(std::bit_cast<std::uint32_t>(value), bytes);
}

std::string_view TakeLine(std::string_view* rest) {
  const std::size_t end = rest->find('\n');
  std::string_view line = rest->substr(0, end);
  rest->remove_prefix(end == std::string_view::npos ? rest->size() : end + 1);
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

std::string_view TakeWord(std::string_view* line) {
  while (!line->empty() && IsBlank(line->front())) line->remove_prefix(1);
  std::size_t size = 0;
  while (size < line->size() && !IsBlank((*line)[size])) ++size;
  const std::string_view word = line->substr(0, size);
  line->remove_prefix(size);
  return word;
}

bool ParseCount(std::string_view text, std::uint64_t max, std::uint64_t* count) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), *count);
  return error == std::errc() && end == text.data() + text.size() && *count <= max;
}

}  // namespace palpate::experiment
