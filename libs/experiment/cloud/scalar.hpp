// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace palpate::experiment {

enum class ByteOrder { kLittle, kBig };

/// How a number is stored: signed or unsigned whole number, IEEE float.
struct Scalar {
  enum class Kind { kSigned, kUnsigned, kFloat };
  Kind kind = Kind::kFloat;
  std::size_t bytes = 4;  ///< 1, 2, 4, 8; of a float 4, 8

  bool IsSound() const;
  /// The number at `data`, which holds enough bytes.
  double Load(const char* data, ByteOrder order) const;
  /// Its bytes as a whole number: of a packed colour.
  std::uint64_t LoadBits(const char* data, ByteOrder order) const;
  /// The number in text; "nan" and "inf" as such. False where it is none.
  bool Parse(std::string_view text, double* value) const;
  /// The bits that Load would have taken the value from.
  std::uint64_t BitsOf(double value) const;
};

void AppendLittleEndian(std::uint32_t value, std::string* bytes);
void AppendLittleEndian(float value, std::string* bytes);

/// The next line without its end; `rest` moves behind it.
std::string_view TakeLine(std::string_view* rest);
/// The next word of a line, between blanks; empty at the end.
std::string_view TakeWord(std::string_view* line);
/// A whole number from 0 to `max`; false for anything else.
bool ParseCount(std::string_view text, std::uint64_t max, std::uint64_t* count);

}  // namespace palpate::experiment
