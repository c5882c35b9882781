// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/monitor/topic_flow.hpp"

namespace palpate::monitor {

void FlowCounter::Add(double now_s, std::optional<std::uint64_t> counter) {
  ++received_;
  if (counter) (void)gaps_.Add(*counter);
  times_s_.push_back(now_s);
  while (now_s - times_s_.front() > kWindow_s) times_s_.pop_front();
}

TopicFlow FlowCounter::At(double now_s) const {
  TopicFlow flow{.received = received_, .lost = gaps_.lost()};
  if (times_s_.empty()) return flow;
  flow.silence_s = now_s - times_s_.back();
  const double passed_s = times_s_.back() - times_s_.front();
  if (flow.silence_s <= kWindow_s && passed_s > 0.0) {
    flow.rate_hz = static_cast<double>(times_s_.size() - 1) / passed_s;
  }
  return flow;
}

}  // namespace palpate::monitor
