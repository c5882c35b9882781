// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <string_view>

namespace palpate::recording {

/// The name that ROS 2 gives a DDS topic: "rt/forces" -> "/forces"; other names stay.
std::string RosTopicName(std::string_view dds_topic);

/// "palpate_msgs::msg::dds_::ForceArray_" -> "palpate_msgs/msg/ForceArray"; other names stay.
std::string RosTypeName(std::string_view dds_type);

}  // namespace palpate::recording
