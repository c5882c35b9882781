// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <algorithm>
#include <optional>

namespace palpate::view {

/// How many messages a client may send: `rate_hz` on average, as many at once as come in a second.
class MessageBudget {
 public:
  explicit MessageBudget(double rate_hz) : rate_hz_(rate_hz), left_(rate_hz) {}

  /// False: this message is one too many. `now_s` of any clock that does not go back.
  bool Take(double now_s) {
    left_ = std::min(rate_hz_, left_ + rate_hz_ * (now_s - last_s_.value_or(now_s)));
    last_s_ = now_s;
    if (left_ < 1.0) return false;
    left_ -= 1.0;
    return true;
  }

 private:
  double rate_hz_;
  double left_;
  std::optional<double> last_s_;
};

}  // namespace palpate::view
