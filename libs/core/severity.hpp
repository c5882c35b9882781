// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>

namespace palpate {

/// Severities of a line of the log, numbered as in ROS 2 (rcl_interfaces/msg/Log).
enum class Severity : std::uint8_t { kDebug = 10, kInfo = 20, kWarning = 30, kError = 40 };

}  // namespace palpate
