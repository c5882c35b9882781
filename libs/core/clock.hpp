// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <functional>

namespace palpate {

/// Nanoseconds now. Time is an argument: whoever needs it takes a Clock, so that tests step it by
/// hand.
using Clock = std::function<std::int64_t()>;

/// Never goes back; counts from an arbitrary time. For durations and deadlines.
std::int64_t MonotonicNow_ns();

/// Since the epoch (UTC), as message stamps are; may jump when the clock is set.
std::int64_t WallNow_ns();

}  // namespace palpate
