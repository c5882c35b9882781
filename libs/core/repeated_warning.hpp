// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "libs/core/clock.hpp"

namespace palpate {

/// Keeps a log short where a warning comes with each frame. The first warning of a kind is due at
/// once. Further ones are counted, and due as one line when a period has passed since the last
/// line. Texts that differ only in their numbers are of one kind. Not thread-safe.
class RepeatedWarning {
 public:
  /// `period_s`: > 0.
  explicit RepeatedWarning(double period_s = 10.0, Clock clock = MonotonicNow_ns);

  /// The line to log now; nullopt: the warning was counted. `latest` tells this warning from the
  /// others of its kind ("stamp 12.3 s"); it may be empty.
  std::optional<std::string> Add(const std::string& text, const std::string& latest);

  /// The lines of counted warnings whose period is over: "TEXT (19 times in the last 10 s, last
  /// LATEST)". To be asked about once a second.
  std::vector<std::string> TakeDue();

 private:
  struct Kind {
    std::string key;
    std::string text;    ///< of the last warning
    std::string latest;  ///< the same
    std::int64_t line_ns = 0;
    std::uint64_t counted = 0;  ///< since the last line
  };

  std::string LineOf(Kind& kind, std::int64_t now_ns) const;

  /// A log that needs more kinds at a time has no use of counting them.
  static constexpr std::size_t kMostKinds = 32;

  std::int64_t period_ns_;
  Clock clock_;
  std::vector<Kind> kinds_;  ///< oldest first
};

/// `text` with each number replaced by '#'. Digits inside a word ("contact_1") stay.
std::string WithoutNumbers(std::string_view text);

}  // namespace palpate
