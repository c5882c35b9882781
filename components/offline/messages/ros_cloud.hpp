// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string_view>

#include "components/offline/messages/message_type.hpp"
#include "libs/experiment/cloud/point_cloud.hpp"

namespace palpate::offline {

/// A sensor_msgs/PointCloud2 with x, y, z as FLOAT32 or FLOAT64, and rgb where it has them; points
/// that are not finite are none. Organised as the message is. False for any other.
[[nodiscard]] bool ReadCloud(std::string_view cdr, const MessageType& type, std::string* frame_id,
                             experiment::PointCloud* cloud);

}  // namespace palpate::offline
