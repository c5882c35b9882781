// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

namespace palpate::recorder {

/// What a file says about the messages of one topic and type.
struct TopicDescription {
  std::string topic;            ///< "/forces"
  std::string type;             ///< "palpate_msgs/msg/ForceArray"
  std::string schema_encoding;  ///< "ros2msg", "omgidl"; empty: nobody told the definition
  std::string schema;
  std::string qos;       ///< offered by its writers, in the YAML of rosbag2
  bool latched = false;  ///< late joiners get the last message
  bool has_key = false;  ///< of its type

  bool operator==(const TopicDescription&) const = default;
};

/// One message on its way into a file. Copies share the bytes.
struct RecordedMessage {
  std::shared_ptr<const TopicDescription> topic;
  std::int64_t log_time_ns = 0;       ///< when it came, since the epoch
  std::int64_t publish_time_ns = 0;   ///< when it was sent, since the epoch
  std::int64_t received_ns = 0;       ///< when it came, of a clock that never jumps
  std::string_view data;              ///< CDR
  std::shared_ptr<const void> owner;  ///< of the data
};

}  // namespace palpate::recorder
