// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "components/recorder/recorded_message.hpp"
#include "libs/recording/reader.hpp"

namespace palpate::recorder {

inline std::shared_ptr<const TopicDescription> SampleTopic(const std::string& name,
                                                           bool latched = false) {
  return std::make_shared<TopicDescription>(
      TopicDescription{name, "test_msgs/msg/T", "ros2msg", "uint8[] data\n", "", latched});
}

/// A message of `size` bytes that came `time_s` after the beginning.
inline RecordedMessage SampleMessage(const std::shared_ptr<const TopicDescription>& topic,
                                     double time_s, std::size_t size = 100) {
  const auto data = std::make_shared<std::string>(size, 'd');
  const auto time_ns = static_cast<std::int64_t>(time_s * 1e9);
  return {topic, 1'000'000'000'000 + time_ns, time_ns, time_ns, *data, data};
}

/// Topics of the messages of a file, in the order of their log time.
inline std::vector<std::string> TopicsIn(const std::filesystem::path& file) {
  const recording::Reader reader(file);
  recording::MessageStream stream = reader.Messages();
  std::vector<std::string> topics;
  while (const recording::Message* message = stream.Next()) {
    topics.push_back(reader.contents().channels.at(message->channel_id).topic);
  }
  return topics;
}

}  // namespace palpate::recorder
