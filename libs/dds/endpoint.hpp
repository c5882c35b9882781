// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "libs/dds/entity.hpp"
#include "libs/dds/topic_table.hpp"

namespace palpate::dds {

/// What befell one writer or reader since its start. Written by DDS's own threads, `taken` by the
/// one that takes.
struct EndpointCounters {
  std::atomic<uint32_t> matched{0};           ///< partners now
  std::atomic<uint32_t> matched_ever{0};      ///< partners since the start, each reappearance too
  std::atomic<uint32_t> sample_lost{0};       ///< reader: never came, or overwritten before taken
  std::atomic<uint32_t> incompatible_qos{0};  ///< partners turned away because of their QoS
  std::atomic<uint32_t> deadline_missed{0};
  std::atomic<uint64_t> taken{0};                     ///< reader: messages that Take() gave
  std::atomic<uint32_t> last_incompatible_policy{0};  ///< dds_qos_policy_id_t
  std::function<void()> on_change;  ///< called from DDS's threads after any of the above
};

/// "reliability", "durability", "deadline", ...; "a policy" for others. `id`: dds_qos_policy_id_t.
std::string PolicyName(uint32_t id);

/// A writer or reader with its topic; the untyped part that Writer and Reader share.
class Endpoint {
 public:
  enum class Kind { kWriter, kReader };

  /// Throws InputError where the table and `descriptor` disagree on the type, RunError where DDS
  /// refuses. `on_change` is called from DDS's threads and must be quick.
  Endpoint(Kind kind, dds_entity_t participant, const TopicSettings& topic,
           const std::string& ros_name, const dds_topic_descriptor_t& descriptor,
           std::function<void()> on_change);

  dds_entity_t handle() const { return entity_.handle(); }
  const std::string& ros_name() const { return ros_name_; }
  const EndpointCounters& counters() const { return *counters_; }
  uint32_t matched() const { return counters_->matched; }

 protected:
  std::atomic<uint64_t>* taken() { return &counters_->taken; }

 private:
  std::string ros_name_;
  std::unique_ptr<EndpointCounters> counters_;  // outlives the entity, whose listener writes to it
  Entity topic_;
  Entity entity_;
};

}  // namespace palpate::dds
