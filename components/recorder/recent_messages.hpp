// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <vector>

#include "components/recorder/recorded_message.hpp"

namespace palpate::recorder {

/// The messages of the last seconds, for a snapshot. Where they need more memory than there is, the
/// largest topic keeps its newest second in full, and one message per slot of the time before.
/// Slots of all topics begin at the same times, so that depth and colour of one frame stay
/// together.
class RecentMessages {
 public:
  RecentMessages(double duration_s, std::uint64_t max_bytes);

  void Add(const RecordedMessage& message);

  /// All that is kept, in the order of their log time, after the last one of each latched topic
  /// that is older.
  std::vector<RecordedMessage> Snapshot() const;

  std::uint64_t bytes() const { return bytes_; }
  /// From the oldest to the newest message of the topic that reaches back least, of those that
  /// lost messages for want of memory; the whole duration where none did.
  double shortest_s() const;
  /// The longest slot of any topic, s; 0: none is thinned.
  double slot_s() const;

 private:
  struct Topic {
    std::deque<RecordedMessage> old;    ///< one per slot
    std::deque<RecordedMessage> fresh;  ///< all
    std::uint64_t bytes = 0;
    std::uint64_t fresh_bytes = 0;
    std::int64_t slot_ns = 0;  ///< 0: all are kept
    std::int64_t slot_changed_ns = 0;
    bool cut = false;  ///< lost its oldest messages for want of memory
  };

  void Age(Topic& topic);
  void Thin(Topic& topic);
  void MakeRoom(Topic& topic);
  void DropOld(Topic& topic, std::int64_t before_ns);
  void DropFirst(Topic& topic);
  void Release(Topic& topic, std::uint64_t size);

  double duration_s_;
  std::uint64_t max_bytes_;
  std::uint64_t bytes_ = 0;
  std::int64_t newest_ns_ = 0;
  std::map<std::string, Topic> topics_;
  std::map<std::string, RecordedMessage> latched_;  ///< dropped ones only
};

}  // namespace palpate::recorder
