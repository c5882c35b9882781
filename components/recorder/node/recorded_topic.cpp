// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/recorder/node/recorded_topic.hpp"

#include <algorithm>
#include <utility>

#include "libs/core/clock.hpp"
#include "libs/core/seconds.hpp"
#include "libs/recording/ros2msg/cdr_reader.hpp"

namespace palpate::recorder {

namespace {

constexpr const char* kCounter = "counter";

void SetRates(std::uint64_t messages, std::uint64_t bytes, std::int64_t elapsed_ns, TopicRow* row) {
  if (elapsed_ns <= 0) return;
  row->rate_hz = static_cast<double>(messages) / NsToSeconds(elapsed_ns);
  row->bytes_per_s = static_cast<double>(bytes) / NsToSeconds(elapsed_ns);
}

}  // namespace

RecordedTopic::RecordedTopic(dds_entity_t participant, const dds::RawTopic& topic,
                             const TopicDescription& description, Sink sink)
    : sink_(std::move(sink)), first_ns_(MonotonicNow_ns()), last_row_ns_(first_ns_) {
  if (description.schema_encoding == "ros2msg") {
    definitions_ = recording::ParseRos2msg(description.type, description.schema);
    const auto& root = definitions_[recording::ShortTypeName(description.type)];
    const bool counts =
        std::any_of(root.fields.begin(), root.fields.end(), [](const recording::Field& field) {
          return field.name == kCounter && field.type == "uint64";
        });
    if (counts) root_ = &root;
  }
  Read(participant, topic, description);
}

void RecordedTopic::Read(dds_entity_t participant, const dds::RawTopic& topic,
                         const TopicDescription& description) {
  if (reader_) lost_before_ += reader_->lost();
  reader_.reset();
  topic_ = topic;
  description_ = std::make_shared<TopicDescription>(description);
  reader_ = std::make_unique<dds::RawReader>(
      participant, topic_, [this](dds::RawMessage message) { Take(std::move(message)); });
}

void RecordedTopic::Take(dds::RawMessage message) {
  CountGaps(message);
  const std::int64_t now_ns = MonotonicNow_ns();
  ++messages_;
  bytes_ += message.cdr().size();
  last_ns_ = now_ns;
  const bool taken = sink_({.topic = description_,
                            .log_time_ns = WallNow_ns(),
                            .publish_time_ns = message.source_time_ns(),
                            .received_ns = now_ns,
                            .data = message.cdr(),
                            .owner = message.owner()});
  if (!taken) ++lost_;
}

void RecordedTopic::CountGaps(const dds::RawMessage& message) {
  if (root_ == nullptr) return;
  const auto counter = recording::UnsignedField(message.cdr(), *root_, kCounter, definitions_);
  if (!counter) return;
  dds::GapCounter& gaps = gaps_[message.writer()];
  const std::uint64_t before = gaps.lost();
  gaps.Add(*counter);
  lost_ += gaps.lost() - before;
}

TopicRow RecordedTopic::Row(std::int64_t now_ns) const {
  TopicRow row;
  row.topic = description_->topic;
  row.type = description_->type;
  row.messages = messages_;
  row.bytes = bytes_;
  // What the messages' own counters tell, DDS may have counted as well.
  row.lost = std::max<std::uint64_t>(lost_, lost_before_ + reader_->lost());
  const std::int64_t last_ns = last_ns_ == 0 ? first_ns_ : last_ns_.load();
  row.age_s = std::max(0.0, NsToSeconds(now_ns - last_ns));
  row.has_schema = !description_->schema.empty();
  return row;
}

TopicRow RecordedTopic::NextRow(std::int64_t now_ns) {
  TopicRow row = Row(now_ns);
  SetRates(row.messages - last_row_.messages, row.bytes - last_row_.bytes, now_ns - last_row_ns_,
           &row);
  last_row_ = row;
  last_row_ns_ = now_ns;
  return row;
}

TopicRow RecordedTopic::MeanRow(std::int64_t now_ns) const {
  TopicRow row = Row(now_ns);
  SetRates(row.messages, row.bytes, now_ns - first_ns_, &row);
  return row;
}

}  // namespace palpate::recorder
