// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "libs/dds/entity.hpp"
#include "libs/dds/topic_table.hpp"

struct ddsi_sertype;

namespace palpate::dds {

/// What a writer without code of the type is to write.
struct RawWriterTopic {
  std::string dds_topic;  ///< "rt/forces"
  std::string dds_type;   ///< "palpate_msgs::msg::dds_::ForceArray_"
  Reliability reliability = Reliability::kReliable;
  Durability durability = Durability::kVolatile;
  int depth = 1;  ///< messages kept, >= 1 (keep-last)
  /// Of its type, which must be as its readers have it. All messages are then kept where the topic
  /// is transient-local, because a late joiner gets the last ones of every instance.
  bool has_key = false;
  bool is_xcdr2 = false;  ///< encoding of all messages; else XCDR1
  bool this_host_only = false;
};

/// Writes messages of any type that are CDR already.
class RawWriter {
 public:
  /// `on_change` is called from DDS's threads when readers come or go, and must be quick. Throws
  /// RunError where DDS refuses.
  RawWriter(dds_entity_t participant, const RawWriterTopic& topic, std::function<void()> on_change);
  RawWriter(const RawWriter&) = delete;
  RawWriter& operator=(const RawWriter&) = delete;

  /// `cdr`: with its header of 4 bytes. Sends in the caller's thread. False where it is too short,
  /// or DDS did not take it (slow reliable readers for longer than 100 ms, no memory).
  [[nodiscard]] bool Write(std::string_view cdr);

  /// Waits until every reliable reader has all that was sent; false where that takes longer.
  [[nodiscard]] bool WaitUntilReceived(std::chrono::nanoseconds at_most);

  dds_entity_t handle() const { return writer_.handle(); }
  std::uint32_t matched() const;       ///< readers now
  std::uint32_t matched_ever() const;  ///< readers since the start, each reappearance too

 private:
  struct State;
  struct DeleteState {
    void operator()(State* state) const;
  };
  struct Callbacks;

  std::unique_ptr<State, DeleteState> state_;  // outlives the writer, whose listener uses it
  Entity topic_;
  Entity writer_;
};

/// Whether a message is encoded as XCDR2, by its header.
bool IsXcdr2(std::string_view cdr);

}  // namespace palpate::dds
