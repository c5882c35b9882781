// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <chrono>

namespace palpate::player {

inline constexpr auto kReportPeriod = std::chrono::seconds(1);
inline constexpr auto kClockPeriod = std::chrono::milliseconds(10);
inline constexpr auto kLastMessagesWait = std::chrono::seconds(2);
/// Until a reader confirms the first message; and for how long after the start it may be unknown
/// whether readers have found the player.
inline constexpr auto kFirstMessagesWait = std::chrono::seconds(1);
inline constexpr auto kDiscoveryTime = std::chrono::seconds(1);

}  // namespace palpate::player
