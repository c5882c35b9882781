// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/offline/messages/message_type.hpp"

#include <utility>

#include "libs/core/error.hpp"
#include "libs/recording/ros_names.hpp"

namespace palpate::offline {

std::unique_ptr<MessageType> TypeOf(const recording::Schema& schema) {
  auto type = std::make_unique<MessageType>();
  type->name = recording::RosTypeName(schema.name);
  if (schema.encoding == "ros2msg" && !schema.data.empty()) {
    type->definitions = recording::ParseRos2msg(type->name, schema.data);
    return type;
  }
  if (schema.encoding == "omgidl" && !schema.data.empty()) {
    try {
      type->definitions = recording::ParseOmgIdl(schema.data);
    } catch (const InputError&) {
      return nullptr;
    }
    type->name = schema.name;
    return type;
  }
  type->definitions = recording::BuiltInDefinitions();
  const bool known = type->definitions.contains(recording::ShortTypeName(type->name));
  return known ? std::move(type) : nullptr;
}

std::int64_t StampOf(const recording::Message& message, const MessageType& type) {
  recording::CdrReader reader = type.At("header", message.data);
  const std::int64_t stamp_ns = reader.Stamp_ns();
  return reader.ok() ? stamp_ns : message.log_time_ns;
}

}  // namespace palpate::offline
