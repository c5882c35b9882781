// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "libs/dds/gap_counter.hpp"
#include "libs/monitor/system_snapshot.hpp"

namespace palpate::monitor {

/// Counts the messages of a topic. Time is an argument, s of any clock.
class FlowCounter {
 public:
  /// `counter`: that the message carries; nullopt: none.
  void Add(double now_s, std::optional<std::uint64_t> counter);

  TopicFlow At(double now_s) const;

 private:
  static constexpr double kWindow_s = 2.0;

  std::deque<double> times_s_;  ///< of the last messages
  std::uint64_t received_ = 0;
  dds::GapCounter gaps_;
};

}  // namespace palpate::monitor
