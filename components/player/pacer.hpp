// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <chrono>
#include <functional>
#include <string>

namespace palpate::player {

/// Says when an event is due. Its clock is an argument, so that tests can turn it by hand.
class Pacer {
 public:
  using Duration = std::chrono::nanoseconds;
  using Clock = std::function<Duration()>;  ///< time since any fixed instant

  /// `rate` > 0: 1 is real time, 2 twice as fast, infinity as fast as possible.
  Pacer(double rate, Clock clock) : rate_(rate), clock_(std::move(clock)) {}

  /// How long to wait from now for the event at `t_s`; 0 where it is due or late. The first event
  /// of each recording is due at once, and so is the first after time went back.
  Duration TimeUntil(const std::string& recording, double t_s);
  /// The next event is due at once.
  void Restart() { started_ = false; }

 private:
  double rate_;
  Clock clock_;
  bool started_ = false;
  std::string recording_;
  double first_t_s_ = 0.0;
  double last_t_s_ = 0.0;
  Duration start_{0};
};

}  // namespace palpate::player
