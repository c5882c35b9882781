// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "libs/core/status.hpp"
#include "libs/rgbd/camera_model.hpp"
#include "libs/rgbd/image.hpp"
#include "sensor_msgs/msg/CameraInfo.hpp"
#include "sensor_msgs/msg/CompressedImage.hpp"
#include "sensor_msgs/msg/Image.hpp"

namespace palpate::perception {

/// Messages of camera drivers, which differ in encodings and lens models. All functions return
/// kInvalidInput, with what came and what is known, for anything else.

/// 16UC1 and mono16 as they are, with `unit_m` = `unit_16bit_m`. 32FC1 (m) in steps of `unit_m` =
/// `largest_z_m` / 65535; 0 where z is not finite, not above 0 or beyond `largest_z_m`.
Status FromDriverDepth(const idl::sensor_msgs::Image& message, double unit_16bit_m,
                       double largest_z_m, rgbd::DepthImage* image, double* unit_m);
/// The same, packed by image_transport as compressedDepth.
Status FromDriverDepth(const idl::sensor_msgs::CompressedImage& message, double unit_16bit_m,
                       double largest_z_m, rgbd::DepthImage* image, double* unit_m);

/// rgb8, bgr8, rgba8, bgra8, and mono8 as grey.
Status FromDriverColor(const idl::sensor_msgs::Image& message, rgbd::ColorImage* image);
/// JPEG or PNG.
Status FromDriverColor(const idl::sensor_msgs::CompressedImage& message, rgbd::ColorImage* image);

/// plumb_bob with four or five numbers, rational_polynomial with eight. `rectified`: of
/// an image without distortion, whose intrinsics are in P. Focal lengths of 0 mean that the driver
/// has no intrinsics.
Status FromDriverInfo(const idl::sensor_msgs::CameraInfo& message, bool rectified,
                      rgbd::CameraModel* camera);

}  // namespace palpate::perception
