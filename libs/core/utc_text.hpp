// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <string>

namespace palpate {

/// "2026-01-31T12:00:00Z" for a time in s since 1970, UTC. Such texts sort by time.
std::string UtcText(std::int64_t since_1970_s);

/// "2026-01-31T12:00:00.250Z" for a time in ns since 1970, UTC, as the lines of the log have it.
std::string UtcTextOfNs(std::int64_t since_1970_ns);

}  // namespace palpate
