// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Geometry>
#include <cstdint>

#include "components/view/config.hpp"
#include "components/view/serve/out_message.hpp"
#include "libs/core/status.hpp"
#include "libs/rgbd/camera_model.hpp"
#include "libs/rgbd/sensed_cloud.hpp"
#include "sensor_msgs/msg/CompressedImage.hpp"
#include "sensor_msgs/msg/Image.hpp"

namespace palpate::view {

/// rgb8, bgr8, rgba8, bgra8 or mono8, as JPEG. kInvalidInput for others; then nothing is set.
Status ColorImageMessage(const idl::sensor_msgs::Image& message, const ImageConfig& config,
                         OutMessage* out);

/// The same of an image that a camera driver has packed, JPEG or PNG.
Status PackedColorMessage(const idl::sensor_msgs::CompressedImage& message,
                          const ImageConfig& config, OutMessage* out);

/// 16UC1, as grey JPEG: light is near, black has no depth. `unit_m`: of a step, > 0.
Status DepthImageMessage(const idl::sensor_msgs::Image& message, double unit_m,
                         const ImageConfig& config, OutMessage* out);

/// The same of an image that a camera driver has packed, of 16 bits, or of 32 bits in m.
Status PackedDepthMessage(const idl::sensor_msgs::CompressedImage& message, double unit_m,
                          const ImageConfig& config, OutMessage* out);

/// Both clouds, in the colour camera's frame, as the pixels of its image that show them.
OutMessage SegmentationMessage(const rgbd::SensedCloud& robot, const rgbd::SensedCloud& object,
                               const Eigen::Isometry3d& T_color_cloud,
                               const rgbd::CameraModel& color, std::int64_t stamp_ns);

}  // namespace palpate::view
