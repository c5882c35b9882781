// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <sstream>
#include <string>

namespace palpate {

namespace internal {

[[noreturn]] void CheckFailed(const char* condition, const char* file, int line,
                              const std::string& values);

template <typename... Values>
std::string DescribeValues(const Values&... values) {
  std::ostringstream text;
  ((text << ' ' << values), ...);
  return text.str();
}

}  // namespace internal

}  // namespace palpate

/// A broken promise of our own code (never of a user or of data): prints the condition and the
/// values given, then aborts. Always on, in release builds too.
#define PALPATE_CHECK(condition, ...)                                                     \
  do {                                                                                    \
    if (!(condition)) [[unlikely]] {                                                      \
      ::palpate::internal::CheckFailed(#condition, __FILE__, __LINE__,                    \
                                       ::palpate::internal::DescribeValues(__VA_ARGS__)); \
    }                                                                                     \
  } while (false)
