// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "libs/dds/topics.hpp"
#include "sensor_msgs/msg/CompressedImage.hpp"

namespace palpate::dds {

// Topics of camera drivers, which AllTopics() also lists.

/// Images as image_transport packs them. Drivers alone publish them.
inline constexpr Topic<idl::sensor_msgs::CompressedImage> kPackedDepthTopic{
    "/camera/depth/image_raw/compressedDepth"};
inline constexpr Topic<idl::sensor_msgs::CompressedImage> kPackedColorTopic{
    "/camera/color/image_raw/compressed"};
/// Frames that may move. Other programs publish them.
inline constexpr Topic<idl::tf2_msgs::TFMessage> kTfTopic{"/tf"};

}  // namespace palpate::dds
