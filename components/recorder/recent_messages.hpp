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

/// The messages of the last seconds, for a snapshot. Where they need more memory than there is,
/// the oldest of the largest topic go first: images reach back less far than all else.
class RecentMessages {
 public:
  RecentMessages(double duration_s, std::uint64_t max_bytes);

  void Add(const RecordedMessage& message);

  /// All that is kept, in the order of their log time, after the last one of each latched topic
  /// that is older.
  std::vector<RecordedMessage> Snapshot() const;

  std::uint64_t bytes() const { return bytes_; }
  /// From the oldest to the newest message of the topic that reaches back least far, of those that
  /// lost messages for want of memory; the whole duration where none did.
  double shortest_s() const;

 private:
  struct Topic {
    std::deque<RecordedMessage> messages;
    std::uint64_t bytes = 0;
    bool cut = false;  ///< lost messages for want of memory
  };

  void DropOld(Topic& topic, std::int64_t before_ns);
  void DropFirst(Topic& topic);

  double duration_s_;
  std::uint64_t max_bytes_;
  std::uint64_t bytes_ = 0;
  std::int64_t newest_ns_ = 0;
  std::map<std::string, Topic> topics_;
  std::map<std::string, RecordedMessage> latched_;  ///< dropped ones only
};

}  // namespace palpate::recorder
