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

}  // namespace palpate
