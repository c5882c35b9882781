// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/core/lateness.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "libs/core/text.hpp"

namespace palpate {

namespace {

/// Older messages are those of recordings.
constexpr double kLongestLive_s = 60.0;

}  // namespace

void Lateness::Add(double delay_s) {
  if (delay_s < kLongestLive_s) least_s_ = std::min(least_s_, delay_s);
}

const Status& Lateness::Judge(const std::string& what) {
  const double least_s = std::exchange(least_s_, kNone);
  if (late_s_ == 0.0 || least_s == kNone) return judgement_;
  if (least_s < late_s_) {
    judgement_ = Status::Ok();
  } else {
    judgement_ = {StatusCode::kStale,
                  what + " come " + FormatNumber(std::round(100.0 * least_s) / 100.0) +
                      " s after they were sent (late_s: " + FormatNumber(late_s_) + ")"};
  }
  return judgement_;
}

}  // namespace palpate
