// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/core/clock.hpp"

#include <chrono>

namespace palpate {

namespace {

template <typename ChronoClock>
std::int64_t Now_ns() {
  const auto since_zero = ChronoClock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::nanoseconds>(since_zero).count();
}

}  // namespace

std::int64_t MonotonicNow_ns() { return Now_ns<std::chrono::steady_clock>(); }

std::int64_t WallNow_ns() { return Now_ns<std::chrono::system_clock>(); }

}  // namespace palpate
