// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "libs/fem/mesh_io/scalar_type.hpp"

namespace palpate::fem::mesh_io {

/// Walks through a file that is text, or text with binary numbers in between (VTK legacy, Gmsh).
/// Every function throws InputError at the place where it could not go on; `what` names the thing
/// that was expected there.
class Scanner {
 public:
  Scanner(std::string file, std::string_view bytes) : file_(std::move(file)), bytes_(bytes) {}

  /// From here on numbers are binary, with their bytes reversed where `swap`.
  void SetBinary(bool swap) {
    binary_ = true;
    swap_ = swap;
  }
  bool binary() const { return binary_; }

  /// The next word, between white space.
  std::string_view Token(const char* what);
  /// The same, or empty at the end of the file.
  std::string_view TokenOrEnd();
  /// What follows from the next word on, without reading it.
  std::string_view Peek() const;
  /// The rest of this line; the next line follows.
  std::string_view Line(const char* what);
  /// The next `count` bytes as they are.
  std::string_view Bytes(size_t count, const char* what);
  /// Goes on behind the next occurrence of `mark`.
  void SkipPast(std::string_view mark);

  /// What Token or TokenOrEnd gave last.
  std::string_view LastToken() const { return bytes_.substr(last_start_, position_ - last_start_); }

  /// A number: a word of text, or `type` in binary. Refuses what is not finite.
  double Real(ScalarType type, const char* what);
  /// The same; what is no finite number becomes NaN.
  double RealOrNan(ScalarType type, const char* what);
  /// An integer in [min, max].
  int64_t Integer(ScalarType type, int64_t min, int64_t max, const char* what);
  /// An integer in [min, max] as a word of text, in binary files too.
  int64_t TextInteger(int64_t min, int64_t max, const char* what);

  /// Throws unless `count` things of at least `bytes_each` bytes can still come.
  void CheckRoom(int64_t count, size_t bytes_each, const char* what);

  /// True where the last word ended at the very end of the file.
  bool LastTokenTouchesEnd() const { return position_ == bytes_.size(); }

  /// Throws InputError at the thing read last.
  [[noreturn]] void Fail(const std::string& message) const;

 private:
  std::string file_;
  std::string_view bytes_;
  size_t position_ = 0;
  size_t last_start_ = 0;  ///< of the thing read last, for messages
  bool binary_ = false;
  bool swap_ = false;
};

}  // namespace palpate::fem::mesh_io
