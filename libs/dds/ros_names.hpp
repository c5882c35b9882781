// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <string_view>

namespace palpate::dds {

/// Whether `name` is a fully qualified ROS topic name: "/a/b_1", no empty part, no part that
/// starts with a digit, no double underscore.
bool IsRosTopicName(std::string_view name);

/// "/forces" -> "rt/forces", the name under which ROS 2 nodes meet on DDS. Throws InputError where
/// `ros_name` is no ROS topic name.
std::string DdsTopicName(std::string_view ros_name);

/// "palpate_msgs/msg/ForceArray" -> "palpate_msgs::msg::dds_::ForceArray_". Throws InputError where
/// `ros_type` is not package/msg/Name.
std::string DdsTypeName(std::string_view ros_type);

/// `text` as one part of a ROS topic name: every other character becomes '_', a leading digit gets
/// one in front, an empty text becomes "_".
std::string RosNamePart(std::string_view text);

}  // namespace palpate::dds
