// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/recordings/message_type.hpp"

#include <utility>

namespace palpate::command {

std::string RosTypeOf(std::string type) {
  const std::size_t middle = type.find("::msg::dds_::");
  if (middle == type.npos || !type.ends_with('_')) return type;
  type.replace(middle, 13, "/msg/");
  type.pop_back();
  return type;
}

std::string RosTopicOf(const std::string& topic) {
  return topic.starts_with("rt/") ? topic.substr(2) : topic;
}

std::unique_ptr<MessageType> TypeOf(const recording::Schema& schema) {
  auto type = std::make_unique<MessageType>();
  type->name = RosTypeOf(schema.name);
  if (schema.encoding == "ros2msg" && !schema.data.empty()) {
    type->definitions = recording::ParseRos2msg(type->name, schema.data);
    return type;
  }
  type->definitions = recording::BuiltInDefinitions();
  const bool known = type->definitions.contains(recording::ShortTypeName(type->name));
  return known ? std::move(type) : nullptr;
}

std::int64_t StampOf(const recording::Message& message, const MessageType& type) {
  recording::CdrReader reader = type.At("header", message.data);
  const auto seconds = static_cast<std::int32_t>(reader.Bits(4));
  const auto ns = static_cast<std::int64_t>(reader.Bits(4));
  if (!reader.ok()) return message.log_time_ns;
  return seconds * std::int64_t{1'000'000'000} + ns;
}

}  // namespace palpate::command
