// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <functional>
#include <memory>
#include <string>

#include "components/palpate/node/topics/topic_summary.hpp"
#include "libs/dds/raw_reader.hpp"
#include "libs/recording/ros2msg/message_definition.hpp"

namespace palpate::command {

/// How one topic is to be read.
struct StreamOptions : GraphOptions {
  std::string topic;
  std::string type;                  ///< ROS name; empty: the publisher's
  std::string reliability = "auto";  ///< of config/topics.yaml, or auto: that of the publishers
  std::string durability = "auto";
  bool decodes = false;  ///< the structure of the type is needed
};

/// A topic that was found, and how to read it.
struct ReadableTopic {
  std::string name;
  std::string type;  ///< "sensor_msgs/msg/Image"; of DDS topics without ROS 2 their DDS name
  dds::RawTopic topic;
  recording::Definitions definitions;  ///< where StreamOptions::decodes
};

/// Reads the messages of one topic, whatever its type.
class TopicStream {
 public:
  using OnMessage = std::function<void(const dds::RawMessage&)>;

  /// Waits for a publisher as long as the options say. Throws RunError where none comes (with "did
  /// you mean"), where the type is unknown or ambiguous, and where DDS refuses.
  explicit TopicStream(const StreamOptions& options);

  const ReadableTopic& topic() const { return topic_; }

  /// Reads until the reader goes, which must be before what `on_message` refers to: it is called
  /// from DDS's threads, one call at a time. Not longer than this object.
  [[nodiscard]] std::unique_ptr<dds::RawReader> Start(OnMessage on_message) const;

  /// What is wrong with the match of publishers and the reader since the last call; "" mostly.
  std::string TakeMismatch(const dds::RawReader& reader);

 private:
  StreamOptions options_;
  dds::DomainGraph graph_;
  ReadableTopic topic_;
  bool mismatch_told_ = false;
};

}  // namespace palpate::command
