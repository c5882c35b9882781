// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <string_view>

#include "components/capture/frame_source.hpp"
#include "libs/dds/message.hpp"
#include "libs/dds/topics.hpp"
#include "libs/rgbd/rgbd_camera.hpp"

namespace palpate::capture {

/// The colour camera's optical frame; registered colour is in the depth camera's.
std::string_view ColorFrameId(const rgbd::RgbdCamera& camera);

/// "host_receive", "device_mapped", "ptp", "replay".
std::string_view NameOf(ClockSource source);
/// "discover", "open", "configure", "stream", "stale", "lost", "ended".
std::string_view NameOf(SourceState state);

/// An image message that points at pixels of somebody else, sent again and again: nothing is copied
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

  dds::Message<idl::sensor_msgs::Image> message_;
  std::uint32_t bytes_per_pixel_;
};

/// A focal length of 0 says "not calibrated", as ROS has it.
dds::Message<idl::sensor_msgs::CameraInfo> ToCameraInfo(const rgbd::CameraModel& camera,
                                                        std::int64_t stamp_ns,
                                                        std::string_view frame_id);

/// The hash is of all but header, epoch and itself, and of both lenses: equal hashes mean that
/// nothing about the camera has changed. `subpixel_sigma_px`: 0 is unknown.
dds::Message<idl::palpate_msgs::CameraSetup> ToCameraSetup(const rgbd::RgbdCamera& camera,
                                                           const SourceHealth& health,
                                                           std::uint32_t epoch,
                                                           std::int64_t stamp_ns,
                                                           double subpixel_sigma_px);

/// Counters since the start are those of `health`.
void SetFrameInfo(const SourceFrame& frame, const SourceHealth& health, std::uint64_t counter,
                  idl::palpate_msgs::FrameInfo* message);

}  // namespace palpate::capture
