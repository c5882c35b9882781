// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>

#include "libs/dds/driver_topics.hpp"
#include "libs/dds/topics.hpp"

namespace palpate::dds {

// Topics of depth cameras beside the first one, which AllTopics() also lists. <name>: the camera's.

inline constexpr Topic<idl::sensor_msgs::Image> kFurtherDepthImageTopic{
    "/camera_<name>/depth/image_raw"};
inline constexpr Topic<idl::sensor_msgs::CameraInfo> kFurtherDepthCameraInfoTopic{
    "/camera_<name>/depth/camera_info"};
inline constexpr Topic<idl::sensor_msgs::Image> kFurtherColorImageTopic{
    "/camera_<name>/color/image_raw"};
inline constexpr Topic<idl::sensor_msgs::CameraInfo> kFurtherColorCameraInfoTopic{
    "/camera_<name>/color/camera_info"};
inline constexpr Topic<idl::sensor_msgs::CompressedImage> kFurtherPackedDepthTopic{
    "/camera_<name>/depth/image_raw/compressedDepth"};
inline constexpr Topic<idl::sensor_msgs::CompressedImage> kFurtherPackedColorTopic{
    "/camera_<name>/color/image_raw/compressed"};
inline constexpr Topic<idl::palpate_msgs::FrameInfo> kFurtherFrameInfoTopic{
    "/camera_<name>/frame_info"};
inline constexpr Topic<idl::palpate_msgs::CameraSetup> kFurtherCameraSetupTopic{
    "/camera_<name>/setup"};
/// What perception made of the camera's part of a frame; /perception/report is of all cameras.
inline constexpr Topic<idl::palpate_msgs::PerceptionReport> kFurtherPerceptionReportTopic{
    "/perception/camera_<name>/report"};

/// Topics and frames of one depth camera.
struct CameraTopics {
  std::string name;    ///< empty: the first camera
  std::string prefix;  ///< of its topics, "/camera" or "/camera_NAME"
  Topic<idl::sensor_msgs::Image> depth = kDepthImageTopic;
  Topic<idl::sensor_msgs::CameraInfo> depth_lens = kDepthCameraInfoTopic;
  Topic<idl::sensor_msgs::Image> color = kColorImageTopic;
  Topic<idl::sensor_msgs::CameraInfo> color_lens = kColorCameraInfoTopic;
  Topic<idl::sensor_msgs::CompressedImage> packed_depth = kPackedDepthTopic;  ///< of drivers
  Topic<idl::sensor_msgs::CompressedImage> packed_color = kPackedColorTopic;  ///< of drivers
  Topic<idl::palpate_msgs::FrameInfo> frame_info = kFrameInfoTopic;
  Topic<idl::palpate_msgs::CameraSetup> setup = kCameraSetupTopic;
  Topic<idl::palpate_msgs::PerceptionReport> report = kPerceptionReportTopic;
  std::string depth_frame;  ///< "camera_depth_optical_frame" or "camera_NAME_depth_optical_frame"
  std::string color_frame;  ///< the same of its colour camera
};

/// Of the camera of that name; empty: the first. Throws InputError where the name is none: letters,
/// digits and single underscores, of which a letter is first.
CameraTopics TopicsOf(const std::string& camera);

}  // namespace palpate::dds
