// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/compare/status_word.hpp"

namespace palpate::command {

std::optional<StatusCode> StatusOfWord(std::string_view word) {
  for (int code = 0; code <= static_cast<int>(StatusCode::kUncertain); ++code) {
    if (ToString(static_cast<StatusCode>(code)) == word) return static_cast<StatusCode>(code);
  }
  return std::nullopt;
}

std::string StatusWords() {
  std::string words;
  for (int code = 0; code <= static_cast<int>(StatusCode::kUncertain); ++code) {
    words += (words.empty() ? "" : ", ") + std::string(ToString(static_cast<StatusCode>(code)));
  }
  return words;
}

}  // namespace palpate::command
