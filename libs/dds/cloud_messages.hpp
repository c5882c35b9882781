// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <string_view>

#include "libs/core/status.hpp"
#include "libs/dds/message.hpp"
#include "libs/rgbd/sensed_cloud.hpp"
#include "sensor_msgs/msg/PointCloud2.hpp"

namespace palpate::dds {

/// 20 bytes a point: x, y, z, rgb (0x00RRGGBB in the bits of a float, as ROS has it), sigma; one
/// row, dense.
Message<idl::sensor_msgs::PointCloud2> ToPointCloud2(const rgbd::SensedCloud& cloud,
                                                     std::int64_t stamp_ns,
                                                     std::string_view frame_id);

/// The same numbers again, bit by bit. kInvalidInput for another layout, data that do not go with
/// the size, a point that is not finite, a sigma that is not above 0.
Status FromPointCloud2(const idl::sensor_msgs::PointCloud2& message, rgbd::SensedCloud* cloud);

}  // namespace palpate::dds
