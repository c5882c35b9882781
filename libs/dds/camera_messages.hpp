// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "libs/core/status.hpp"
#include "libs/dds/message.hpp"
#include "libs/geometry/frames.hpp"
#include "libs/rgbd/image.hpp"
#include "libs/rgbd/rgbd_camera.hpp"
#include "palpate_msgs/msg/CameraSetup.hpp"
#include "sensor_msgs/msg/CameraInfo.hpp"
#include "sensor_msgs/msg/Image.hpp"

namespace palpate::dds {

/// The colour camera's optical frame; registered colour is in the depth camera's.
std::string_view ColorFrameId(const rgbd::RgbdCamera& camera);

/// An image message that points at pixels of its caller, sent again and again: nothing is copied
/// before DDS itself does.
class ImageMessage {
 public:
  ImageMessage(std::string_view encoding, std::uint32_t bytes_per_pixel);

  /// The message of these pixels, which must stay as they are while it is used.
  template <typename T, int kChannels>
  const idl::sensor_msgs::Image& Of(const rgbd::Image<T, kChannels>& image, std::int64_t stamp_ns,
                                    std::string_view frame_id) {
    return Point(reinterpret_cast<const std::uint8_t*>(image.values.data()), image.width_px,
                 image.height_px, stamp_ns, frame_id);
  }

 private:
  const idl::sensor_msgs::Image& Point(const std::uint8_t* pixels, int width_px, int height_px,
                                       std::int64_t stamp_ns, std::string_view frame_id);

  Message<idl::sensor_msgs::Image> message_;
  std::uint32_t bytes_per_pixel_;
};

/// A focal length of 0 says "not calibrated", as ROS has it.
Message<idl::sensor_msgs::CameraInfo> ToCameraInfo(const rgbd::CameraModel& camera,
                                                   std::int64_t stamp_ns,
                                                   std::string_view frame_id);

/// One lens; where K is all zeros the focal lengths are 0: not calibrated. kInvalidInput for
/// numbers that are not finite, an image without pixels, a lens that DistortionOf does not take.
Status FromCameraInfo(const idl::sensor_msgs::CameraInfo& message, rgbd::CameraModel* camera);

/// kInvalidInput for an image without pixels, rows or data that are too short.
Status CheckImageSize(const idl::sensor_msgs::Image& message, std::uint32_t pixel_bytes);

/// Which camera it is, and since when.
struct CameraIdentity {
  std::string device;  ///< "vendor-serial", or the replayed folder
  std::string model;
  std::uint32_t epoch = 0;         ///< rises whenever the camera was reopened
  double subpixel_sigma_px = 0.0;  ///< of the disparity noise; 0: unknown
};

/// The hash is of all but header, epoch and itself, and of both lenses: equal hashes mean that
/// nothing about the camera has changed.
Message<idl::palpate_msgs::CameraSetup> ToCameraSetup(
    const rgbd::RgbdCamera& camera, const CameraIdentity& identity, std::int64_t stamp_ns,
    std::string_view depth_frame = geometry::kCameraDepthOpticalFrame);

}  // namespace palpate::dds
