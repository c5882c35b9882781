// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/core/utc_text.hpp"

#include <ctime>

namespace palpate {

std::string UtcText(std::int64_t since_1970_s) {
  const auto time = static_cast<std::time_t>(since_1970_s);
  std::tm utc{};
  gmtime_r(&time, &utc);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text;
}

std::string UtcTextOfNs(std::int64_t since_1970_ns) {
  constexpr std::int64_t kMs_ns = 1'000'000;
  // Rounded down, before 1970 too.
  const std::int64_t ms = since_1970_ns / kMs_ns - (since_1970_ns % kMs_ns < 0 ? 1 : 0);
  const std::int64_t s = ms / 1000 - (ms % 1000 < 0 ? 1 : 0);
  const std::string after_point = std::to_string(1000 + (ms - 1000 * s)).substr(1);
  std::string text = UtcText(s);
  return text.insert(text.size() - 1, "." + after_point);
}

}  // namespace palpate
