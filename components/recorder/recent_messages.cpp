// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/recorder/recent_messages.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "libs/core/seconds.hpp"

namespace palpate::recorder {

namespace {

/// So much of a topic is kept in full, unless it takes more than this share of the memory.
constexpr std::int64_t kFresh_ns = 1'000'000'000;
constexpr std::uint64_t kFreshShare = 4;
constexpr std::int64_t kLeastSlot_ns = 125'000'000;

bool IsOneSlot(const RecordedMessage& a, const RecordedMessage& b, std::int64_t slot_ns) {
  return slot_ns > 0 && a.received_ns / slot_ns == b.received_ns / slot_ns;
}

}  // namespace

RecentMessages::RecentMessages(double duration_s, std::uint64_t max_bytes)
    : duration_s_(duration_s), max_bytes_(max_bytes) {}

void RecentMessages::Release(Topic& topic, std::uint64_t size) {
  topic.bytes -= size;
  bytes_ -= size;
}

void RecentMessages::DropFirst(Topic& topic) {
  const bool is_old = !topic.old.empty();
  std::deque<RecordedMessage>& messages = is_old ? topic.old : topic.fresh;
  RecordedMessage& first = messages.front();
  Release(topic, first.data.size());
  if (!is_old) topic.fresh_bytes -= first.data.size();
  if (first.topic->latched) latched_[first.topic->topic] = std::move(first);
  messages.pop_front();
}

void RecentMessages::DropOld(Topic& topic, std::int64_t before_ns) {
  const auto is_before = [&](const std::deque<RecordedMessage>& messages) {
    return !messages.empty() && messages.front().received_ns < before_ns;
  };
  while (is_before(topic.old) || (topic.old.empty() && is_before(topic.fresh))) DropFirst(topic);
}

/// What is no longer fresh stays where it is the first of its slot.
void RecentMessages::Age(Topic& topic) {
  while (topic.fresh.size() > 1 && (topic.fresh_bytes > max_bytes_ / kFreshShare ||
                                    topic.fresh.front().received_ns < newest_ns_ - kFresh_ns)) {
    RecordedMessage& first = topic.fresh.front();
    topic.fresh_bytes -= first.data.size();
    if (!topic.old.empty() && IsOneSlot(topic.old.back(), first, topic.slot_ns)) {
      Release(topic, first.data.size());
    } else {
      topic.old.push_back(std::move(first));
    }
    topic.fresh.pop_front();
  }
}

void RecentMessages::Thin(Topic& topic) {
  std::deque<RecordedMessage> kept;
  for (RecordedMessage& message : topic.old) {
    if (!kept.empty() && IsOneSlot(kept.back(), message, topic.slot_ns)) {
      Release(topic, message.data.size());
    } else {
      kept.push_back(std::move(message));
    }
  }
  topic.old.swap(kept);
}

void RecentMessages::MakeRoom(Topic& topic) {
  if (NsToSeconds(topic.slot_ns) < duration_s_) {
    topic.slot_ns = std::max(kLeastSlot_ns, 2 * topic.slot_ns);
    topic.slot_changed_ns = newest_ns_;
    Thin(topic);
  } else {
    DropFirst(topic);
    topic.cut = true;
  }
}

void RecentMessages::Add(const RecordedMessage& message) {
  if (duration_s_ <= 0.0) return;
  newest_ns_ = std::max(newest_ns_, message.received_ns);
  Topic& own = topics_[message.topic->topic];
  own.fresh.push_back(message);
  own.bytes += message.data.size();
  own.fresh_bytes += message.data.size();
  bytes_ += message.data.size();
  Age(own);
  DropOld(own, newest_ns_ - std::llround(1e9 * duration_s_));
  const bool is_settled = NsToSeconds(newest_ns_ - own.slot_changed_ns) > duration_s_;
  if (own.slot_ns > 0 && bytes_ < max_bytes_ / 2 && is_settled) {
    own.slot_ns = own.slot_ns > kLeastSlot_ns ? own.slot_ns / 2 : 0;
    own.slot_changed_ns = newest_ns_;
  }
  while (bytes_ > max_bytes_) {
    const auto largest = std::max_element(
        topics_.begin(), topics_.end(),
        [](const auto& a, const auto& b) { return a.second.bytes < b.second.bytes; });
    MakeRoom(largest->second);
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
    for (const std::deque<RecordedMessage>* messages : {&topic.old, &topic.fresh}) {
      for (const RecordedMessage& message : *messages) {
        if (message.received_ns >= before_ns) {
          all.push_back(message);
        } else if (message.topic->latched) {
          latched = message;
        }
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
    const std::deque<RecordedMessage>& first = topic.old.empty() ? topic.fresh : topic.old;
    const double kept_s = first.empty() ? 0.0 : NsToSeconds(newest_ns_ - first.front().received_ns);
    shortest_s = std::min(shortest_s, kept_s);
  }
  return shortest_s;
}

double RecentMessages::slot_s() const {
  std::int64_t longest_ns = 0;
  for (const auto& [name, topic] : topics_) longest_ns = std::max(longest_ns, topic.slot_ns);
  return NsToSeconds(longest_ns);
}

}  // namespace palpate::recorder
