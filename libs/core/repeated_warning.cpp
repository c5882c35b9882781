// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/core/repeated_warning.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <utility>

#include "libs/core/check.hpp"
#include "libs/core/seconds.hpp"

namespace palpate {

namespace {

bool IsDigit(char letter) { return std::isdigit(static_cast<unsigned char>(letter)) != 0; }
bool IsOfWord(char letter) {
  return std::isalnum(static_cast<unsigned char>(letter)) != 0 || letter == '_';
}

}  // namespace

std::string WithoutNumbers(std::string_view text) {
  std::string kind;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool begins = IsDigit(text[i]) && (i == 0 || !IsOfWord(text[i - 1]));
    if (!begins) {
      kind += text[i];
      continue;
    }
    kind += '#';
    // Up to the end of 1.25e-05.
    while (i + 1 < text.size() &&
           (IsDigit(text[i + 1]) || text[i + 1] == '.' ||
            ((text[i + 1] == 'e' || text[i + 1] == '-') && i + 2 < text.size() &&
             (IsDigit(text[i + 2]) || text[i + 2] == '-')))) {
      ++i;
    }
  }
  return kind;
}

RepeatedWarning::RepeatedWarning(double period_s, Clock clock)
    : period_ns_(static_cast<std::int64_t>(std::llround(1e9 * period_s))),
      clock_(std::move(clock)) {
  PALPATE_CHECK(period_s > 0.0, period_s);
}

std::optional<std::string> RepeatedWarning::Add(const std::string& text,
                                                const std::string& latest) {
  const std::int64_t now_ns = clock_();
  const std::string key = WithoutNumbers(text);
  auto kind = std::find_if(kinds_.begin(), kinds_.end(),
                           [&](const Kind& known) { return known.key == key; });
  const bool is_new =
      kind == kinds_.end() || (kind->counted == 0 && now_ns - kind->line_ns >= period_ns_);
  if (kind != kinds_.end()) {
    kind->text = text;
    kind->latest = latest;
  }
  if (!is_new) {
    ++kind->counted;
    return std::nullopt;
  }
  if (kind != kinds_.end()) kinds_.erase(kind);
  if (kinds_.size() == kMostKinds) kinds_.erase(kinds_.begin());
  kinds_.push_back({key, text, latest, now_ns, 0});
  return latest.empty() ? text : text + " (" + latest + ")";
}

std::vector<std::string> RepeatedWarning::TakeDue() {
  const std::int64_t now_ns = clock_();
  std::vector<std::string> lines;
  for (Kind& kind : kinds_) {
    if (kind.counted == 0 || now_ns - kind.line_ns < period_ns_) continue;
    lines.push_back(LineOf(kind, now_ns));
  }
  return lines;
}

std::string RepeatedWarning::LineOf(Kind& kind, std::int64_t now_ns) const {
  const std::int64_t passed_s = std::llround(NsToSeconds(now_ns - kind.line_ns));
  std::string line = kind.text + " (" + std::to_string(kind.counted) +
                     (kind.counted == 1 ? " time" : " times") + " in the last " +
                     std::to_string(passed_s) + " s";
  if (!kind.latest.empty()) line += ", last " + kind.latest;
  kind.counted = 0;
  kind.line_ns = now_ns;
  return line + ")";
}

}  // namespace palpate
