// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace palpate::experiment {

/// How the machine that wrote a C3D file stored numbers; the values are those of the file.
enum class C3dProcessor : std::uint8_t {
  kIntel = 84,  ///< little-endian, IEEE 754
  kDec = 85,    ///< little-endian integers, VAX F reals
  kMips = 86,   ///< big-endian, IEEE 754
};

/// The bytes of a C3D file, read at offsets from 0. Every access beyond the end throws InputError
/// with the offset.
class C3dBytes {
 public:
  explicit C3dBytes(const std::filesystem::path& file);

  std::size_t size() const { return bytes_.size(); }
  void set_processor(C3dProcessor processor) { processor_ = processor; }

  std::uint8_t Byte(std::size_t offset) const;
  std::int8_t SignedByte(std::size_t offset) const;
  std::int16_t Int16(std::size_t offset) const;
  std::uint16_t Uint16(std::size_t offset) const;
  /// May be infinite or NaN where the file is.
  double Real(std::size_t offset) const;
  std::string_view Text(std::size_t offset, std::size_t count) const;

  /// Throws InputError unless [offset, offset + count) lies in the file; `what` names it.
  void Require(std::size_t offset, std::size_t count, std::string_view what) const;
  /// Throws InputError: "file: at byte <offset>: message".
  [[noreturn]] void Refuse(std::size_t offset, const std::string& message) const;

 private:
  std::string file_;
  std::string bytes_;
  C3dProcessor processor_ = C3dProcessor::kIntel;
};

}  // namespace palpate::experiment
