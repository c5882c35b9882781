// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/camera_topics.hpp"

#include <cctype>

#include "libs/core/error.hpp"
#include "libs/dds/ros_names.hpp"
#include "libs/geometry/frames.hpp"

namespace palpate::dds {

CameraTopics TopicsOf(const std::string& camera) {
  CameraTopics topics;
  topics.name = camera;
  topics.prefix = "/camera";
  topics.depth_frame = geometry::kCameraDepthOpticalFrame;
  topics.color_frame = geometry::kCameraColorOpticalFrame;
  if (camera.empty()) return topics;
  topics.prefix += "_" + camera;
  const bool begins_well = std::isalpha(static_cast<unsigned char>(camera.front())) != 0;
  const bool is_part = camera.find('/') == camera.npos && IsRosTopicName(topics.prefix);
  if (!begins_well || !is_part) {
    throw InputError("'" + camera +
                     "' is no name of a camera (letters, digits, _; a letter is first)");
  }
  topics.depth = kFurtherDepthImageTopic;
  topics.depth_lens = kFurtherDepthCameraInfoTopic;
  topics.color = kFurtherColorImageTopic;
  topics.color_lens = kFurtherColorCameraInfoTopic;
  topics.packed_depth = kFurtherPackedDepthTopic;
  topics.packed_color = kFurtherPackedColorTopic;
  topics.frame_info = kFurtherFrameInfoTopic;
  topics.setup = kFurtherCameraSetupTopic;
  topics.report = kFurtherPerceptionReportTopic;
  topics.depth_frame = "camera_" + camera + "_depth_optical_frame";
  topics.color_frame = "camera_" + camera + "_color_optical_frame";
  return topics;
}

}  // namespace palpate::dds
