// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "libs/dds/entity.hpp"
#include "libs/dds/raw_message.hpp"
#include "libs/dds/topic_table.hpp"

namespace palpate::dds {

/// What a reader without code of the type is to read.
struct RawTopic {
  std::string dds_topic;  ///< "rt/forces"
  std::string dds_type;   ///< "palpate_msgs::msg::dds_::ForceArray_"
  Reliability reliability = Reliability::kReliable;
  Durability durability = Durability::kVolatile;
  bool has_key = false;         ///< of its type
  bool this_host_only = false;  ///< also in PartitionOfThisHost()
};

/// Reads messages of any type as CDR, but those of its own participant. Whoever gets them is called
/// from DDS's own threads, one call at a time, and must be quick.
class RawReader {
 public:
  using OnMessage = std::function<void(RawMessage)>;

  /// Throws RunError where DDS refuses.
  RawReader(dds_entity_t participant, const RawTopic& topic, OnMessage on_message);
  RawReader(const RawReader&) = delete;
  RawReader& operator=(const RawReader&) = delete;

  dds_entity_t handle() const { return reader_.handle(); }
  /// Messages that came, and were gone before they could be taken, or never came.
  std::uint64_t lost() const { return state_->lost; }
  std::uint32_t matched() const { return state_->matched; }
  /// Whether a writer was turned away because of its QoS.
  bool has_incompatible_writer() const { return state_->incompatible > 0; }
  /// Because of which policy, dds_qos_policy_id_t.
  std::uint32_t last_incompatible_policy() const { return state_->policy; }

 private:
  struct State {
    OnMessage on_message;
    std::atomic<std::uint64_t> lost{0};
    std::atomic<std::uint32_t> matched{0};
    std::atomic<std::uint32_t> incompatible{0};
    std::atomic<std::uint32_t> policy{0};  ///< of the last of these
  };
  struct Callbacks;

  std::unique_ptr<State> state_;  // outlives the reader, whose listener uses it
  Entity topic_;
  Entity reader_;
};

}  // namespace palpate::dds
