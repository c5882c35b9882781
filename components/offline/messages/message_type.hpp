// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "libs/recording/recorded_messages.hpp"
#include "libs/recording/ros2msg/flatten.hpp"

namespace palpate::offline {

/// A message type as one recording defines it.
struct MessageType {
  std::string name;  ///< "sensor_msgs/msg/Image"
  recording::Definitions definitions;

  /// A reader that stands before a field of the message, not ok() where it has none.
  recording::CdrReader At(const std::string& field, std::string_view cdr) const {
    return recording::AtField(cdr, name, field, definitions);
  }
};

/// The recording's own definition, else the built-in one; nullptr where there is none.
std::unique_ptr<MessageType> TypeOf(const recording::Schema& schema);

/// Stamp of the message's header, else its log time, ns.
std::int64_t StampOf(const recording::Message& message, const MessageType& type);

}  // namespace palpate::offline
