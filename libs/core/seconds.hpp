// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <chrono>
#include <cstdint>

/// Seconds as a number, and what the standard library has for them.
namespace palpate {

template <typename Rep, typename Period>
double ToSeconds(std::chrono::duration<Rep, Period> duration) {
  return std::chrono::duration<double>(duration).count();
}

inline double NsToSeconds(std::int64_t time_ns) { return 1e-9 * static_cast<double>(time_ns); }

/// Of the steady clock, rounded towards zero; at most some 292 years.
inline std::chrono::steady_clock::duration FromSeconds(double seconds) {
  return std::chrono::duration_cast<std::chrono::steady_clock::duration>(
      std::chrono::duration<double>(seconds));
}

inline double SecondsSince(std::chrono::steady_clock::time_point then) {
  return ToSeconds(std::chrono::steady_clock::now() - then);
}

}  // namespace palpate
