// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "components/recorder/recorded_message.hpp"
#include "libs/dds/publications.hpp"
#include "libs/recording/ros2msg/message_definition.hpp"

namespace palpate::recorder {

/// The QoS of a writer in the YAML that rosbag2 writes into a channel.
std::string QosYaml(const dds::Publication& publication);

/// What a file says about a topic. The definition is the built-in one, or that of a ROS 2
/// installation (AMENT_PREFIX_PATH), or what the writer sent.
TopicDescription Describe(const dds::Publication& publication);

/// The built-in definition of a type, or that of a ROS 2 installation; nullopt: none.
std::optional<std::string> FindRos2msg(const std::string& ros_type);

}  // namespace palpate::recorder
