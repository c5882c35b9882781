// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <limits>
#include <string>

#include "libs/core/status.hpp"

namespace palpate {

/// Judges how long after they were sent the messages of an input come. One late message is a hiccup
/// of the machine; an input is late while all of its messages are.
class Lateness {
 public:
  /// `late_s`: delay from which a message is late; 0: none is.
  explicit Lateness(double late_s) : late_s_(late_s) {}

  /// A message came so long after it was sent. Messages of recordings, which were sent long ago,
  /// are not judged.
  void Add(double delay_s);

  /// kStale, with the delay, where all messages since the last call were late; to be called about
  /// once a second. Without messages the last judgement stays. `what`: "frames".
  const Status& Judge(const std::string& what);

 private:
  static constexpr double kNone = std::numeric_limits<double>::infinity();

  double late_s_;
  double least_s_ = kNone;  ///< since the last call
  Status judgement_ = Status::Ok();
};

}  // namespace palpate
