// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <stdexcept>
#include <string>

namespace palpate {

/// A place in an input file. Line and column count from 1; 0 means "the file as a whole".
struct SourceLocation {
  std::string file;
  int line = 0;
  int column = 0;

  /// "file:line:column", without the parts that are 0.
  std::string ToString() const;
};

/// Bad settings, files or data, found before the work starts: the program exits with 2.
/// what() is "file:line:column: message"; the message holds the value and the rule.
class InputError : public std::runtime_error {
 public:
  explicit InputError(const std::string& message) : std::runtime_error(message) {}
  InputError(const SourceLocation& where, const std::string& message)
      : std::runtime_error(where.ToString() + ": " + message) {}
};

/// Sound input, but the work failed while running (no convergence, full disk): exits with 1.
class RunError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace palpate
