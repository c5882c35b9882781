// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>

#include "components/recorder/recorded_message.hpp"
#include "components/recorder/status_table.hpp"
#include "libs/dds/gap_counter.hpp"
#include "libs/dds/raw_reader.hpp"
#include "libs/recording/ros2msg/message_definition.hpp"

namespace palpate::recorder {

/// Reads one topic of one type and counts what comes.
class RecordedTopic {
 public:
  /// Takes a message over; false where it is dropped. Called from DDS's threads.
  using Sink = std::function<bool(RecordedMessage)>;

  /// Throws RunError where DDS refuses.
  RecordedTopic(dds_entity_t participant, const dds::RawTopic& topic,
                const TopicDescription& description, Sink sink);

  const dds::RawTopic& topic() const { return topic_; }
  const TopicDescription& description() const { return *description_; }

  /// Reads with other QoS from now on, for a writer that offers less. Throws RunError.
  void Read(dds_entity_t participant, const dds::RawTopic& topic,
            const TopicDescription& description);

  /// With the rates since the last call.
  TopicRow NextRow(std::int64_t now_ns);
  /// With the mean rates.
  TopicRow MeanRow(std::int64_t now_ns) const;

 private:
  void Take(dds::RawMessage message);
  void CountGaps(const dds::RawMessage& message);
  TopicRow Row(std::int64_t now_ns) const;

  dds::RawTopic topic_;
  std::shared_ptr<const TopicDescription> description_;
  Sink sink_;
  recording::Definitions definitions_;  ///< empty where messages have no counter
  const recording::MessageDefinition* root_ = nullptr;
  std::map<std::uint64_t, dds::GapCounter> gaps_;  ///< by writer; used by DDS's thread only
  std::atomic<std::uint64_t> messages_{0};
  std::atomic<std::uint64_t> bytes_{0};
  std::atomic<std::uint64_t> lost_{0};
  std::atomic<std::int64_t> last_ns_{0};
  std::int64_t first_ns_ = 0;
  TopicRow last_row_;
  std::int64_t last_row_ns_ = 0;
  std::uint64_t lost_before_ = 0;           ///< by readers that were replaced
  std::unique_ptr<dds::RawReader> reader_;  ///< goes first: its thread uses all of the above
};

}  // namespace palpate::recorder
