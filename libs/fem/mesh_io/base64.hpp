// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace palpate::fem::mesh_io {

/// Base64 (RFC 4648, section 4), with padding.
std::string EncodeBase64(std::string_view bytes);

/// Decodes base64 text piece by piece. White space is passed over, and padding may stand in the
/// middle, as between the header and the data of a VTK array that were encoded apart.
class Base64Decoder {
 public:
  explicit Base64Decoder(std::string_view text) : text_(text) {}

  /// Appends the next `count` bytes to `out`; false where the text ends before or is no base64.
  [[nodiscard]] bool Read(size_t count, std::string* out);

  /// The most bytes that can still come.
  size_t UpperBound() const { return pending_.size() + (text_.size() - position_) / 4 * 3 + 3; }

  /// True where nothing but white space is left.
  bool AtEnd() const;

 private:
  bool DecodeQuad();
  /// Decodes as many whole groups of four letters in a row as there are, `at_most` at most.
  size_t DecodeRun(size_t at_most, char* out);

  std::string_view text_;
  size_t position_ = 0;
  std::string pending_;  ///< decoded and not yet read, 3 bytes at most
};

}  // namespace palpate::fem::mesh_io
