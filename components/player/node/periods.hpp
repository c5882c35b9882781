// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <chrono>

namespace palpate::player {

inline constexpr auto kReportPeriod = std::chrono::seconds(1);
inline constexpr auto kClockPeriod = std::chrono::milliseconds(10);
inline constexpr auto kLastMessagesWait = std::chrono::seconds(2);

}  // namespace palpate::player
