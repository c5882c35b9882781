// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/recorder/recent_messages.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "libs/core/seconds.hpp"

namespace palpate::recorder {

RecentMessages::RecentMessages(double duration_s, std::uint64_t max_bytes)
    : duration_s_(duration_s), max_bytes_(max_bytes) {}

void RecentMessages::DropFirst(Topic& topic) {
  RecordedMessage& first = topic.messages.front();
  topic.bytes -= first.data.size();
  bytes_ -= first.data.size();
  if (first.topic->latched) latched_[first.topic->topic] = std::move(first);
  topic.messages.pop_front();
}

void RecentMessages::DropOld(Topic& topic, std::int64_t before_ns) {
  while (!topic.messages.empty() && topic.messages.front().received_ns < before_ns) {
    DropFirst(topic);
  }
}

void RecentMessages::Add(const RecordedMessage& message) {
  if (duration_s_ <= 0.0) return;
  newest_ns_ = std::max(newest_ns_, message.received_ns);
  Topic& own = topics_[message.topic->topic];
  own.messages.push_back(message);
  own.bytes += message.data.size();
  bytes_ += message.data.size();
  const std::int64_t before_ns = newest_ns_ - std::llround(1e9 * duration_s_);
  DropOld(own, before_ns);
  while (bytes_ > max_bytes_) {
    const auto largest = std::max_element(
        topics_.begin(), topics_.end(),
        [](const auto& a, const auto& b) { return a.second.bytes < b.second.bytes; });
    DropFirst(largest->second);
    largest->second.cut = true;
  }
}

std::vector<RecordedMessage> RecentMessages::Snapshot() const {
  const std::int64_t before_ns = newest_ns_ - std::llround(1e9 * duration_s_);
  std::vector<RecordedMessage> all;
  for (const auto& [name, topic] : topics_) {
    // What a late joiner at the beginning of the snapshot would have got.
    std::optional<RecordedMessage> latched;
    if (const auto dropped = latched_.find(name); dropped != latched_.end()) {
      latched = dropped->second;
    }
    for (const RecordedMessage& message : topic.messages) {
      if (message.received_ns >= before_ns) {
        all.push_back(message);
      } else if (message.topic->latched) {
        latched = message;
      }
    }
    if (latched) all.push_back(*latched);
  }
  std::stable_sort(all.begin(), all.end(), [](const RecordedMessage& a, const RecordedMessage& b) {
    return a.received_ns < b.received_ns;
  });
  return all;
}

double RecentMessages::shortest_s() const {
  double shortest_s = duration_s_;
  for (const auto& [name, topic] : topics_) {
    if (!topic.cut) continue;
    const double kept_s =
        topic.messages.empty() ? 0.0 : NsToSeconds(newest_ns_ - topic.messages.front().received_ns);
    shortest_s = std::min(shortest_s, kept_s);
  }
  return shortest_s;
}

}  // namespace palpate::recorder
