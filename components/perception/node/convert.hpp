// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "components/perception/observation.hpp"
#include "libs/core/status.hpp"
#include "libs/dds/message.hpp"
#include "libs/dds/topics.hpp"
#include "libs/rgbd/rgbd_camera.hpp"

namespace palpate::perception {

/// Pixels of /camera/depth/image_raw (16UC1). kInvalidInput for another frame or encoding, rows or
/// data that are too short.
Status FromDepthImage(const idl::sensor_msgs::Image& message, rgbd::DepthImage* image);
/// The same of /camera/color/image_raw (rgb8), which may be in either camera's frame.
Status FromColorImage(const idl::sensor_msgs::Image& message, rgbd::ColorImage* image);

/// What holds for an epoch of a camera.
struct CameraSetup {
  std::int64_t stamp_ns = 0;
  std::uint32_t epoch = 0;
  std::string device;
  rgbd::RgbdCamera camera;  ///< without the lenses
  std::optional<double> subpixel_sigma_px;
};
/// kInvalidInput for units that are no lengths, an invalid value beyond 16 bits, a pose that is
/// none.
Status FromCameraSetup(const idl::palpate_msgs::CameraSetup& message, CameraSetup* setup);

/// What comes of one frame, and where it came from.
struct FrameOutcome {
  std::int64_t stamp_ns = 0;
  std::uint64_t frame_counter = 0;
  std::uint32_t epoch = 0;
  std::string device;
  geometry::DepthPicture picture;        ///< of the depth image
  std::int64_t prediction_stamp_ns = 0;  ///< 0: none was used
  Observation observation;
};

/// Counter, age and latency are set by the sender.
dds::Message<idl::palpate_msgs::PerceptionReport> ToReport(const FrameOutcome& outcome);
/// Counter as above.
dds::Message<idl::palpate_msgs::ContactArray> ToContactArray(const FrameOutcome& outcome);

}  // namespace palpate::perception
