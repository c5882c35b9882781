// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "components/offline/messages/collected_topics.hpp"
#include "libs/geometry/pose_text.hpp"
#include "libs/rgbd/rgbd_camera.hpp"

namespace palpate::offline {

/// The camera of a recording.
struct RecordedCamera {
  rgbd::RgbdCamera camera;
  bool use_color = false;
  std::vector<std::string> frame_ids;  ///< of the depth camera's optical frame
  std::optional<Eigen::Isometry3d> T_robot_camera;
  std::optional<geometry::PoseStandardError> T_robot_camera_error;
};

/// Intrinsics are those of the topic that --remap names, else of camera_info beside the images,
/// else of the only one with their frame and size. Throws InputError where the depth camera has
/// none. Without images only the frame's name is set.
RecordedCamera FindCamera(const recording::RecordedMessages& recorded, const TopicRoles& roles,
                          const CollectedTopics& topics, const std::string& robot_frame,
                          std::vector<std::string>* notes);

}  // namespace palpate::offline
