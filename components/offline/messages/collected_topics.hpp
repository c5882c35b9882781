// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "components/offline/messages/topic_roles.hpp"
#include "components/offline/messages/transform_tree.hpp"
#include "libs/geometry/pose_text.hpp"
#include "libs/rgbd/camera_model.hpp"

namespace palpate::offline {

/// When a message was made, and when it was recorded.
struct MessageTime {
  std::int64_t stamp_ns = 0;  ///< of its header
  std::int64_t log_ns = 0;
  std::int64_t t_ns = 0;  ///< on the clock of the experiment, once that is chosen
  int segment = 0;        ///< of CollectedTopics::segments
};

struct CollectedImage {
  MessageTime time;
  std::string frame_id;
};

struct CollectedInfo {
  MessageTime time;
  std::string frame_id;
  std::uint16_t channel = 0;
  rgbd::CameraModel model;      ///< by K and D
  rgbd::CameraModel rectified;  ///< by P, without distortion
  std::string fault;            ///< why `model` cannot be used; empty: it can
  std::string rectified_fault;
};

struct CollectedSetup {
  MessageTime time;
  double depth_unit_m = 0.0;
  int invalid_value = 0;
  double baseline_m = 0.0;
  double subpixel_px = 0.0;  ///< 0: unknown
  bool knows_color = false;  ///< the next two hold
  bool color_registered = false;
  Eigen::Isometry3d T_depth_color = Eigen::Isometry3d::Identity();
};

struct CollectedMarker {
  std::string name;
  std::optional<Eigen::Vector3d> position_m;
  Eigen::Vector3d sigma_m = Eigen::Vector3d::Zero();
};

struct CollectedMarkers {
  MessageTime time;
  std::string frame_id;
  std::string recording;
  int reference_shape = 0;  ///< MarkerArray3::REFERENCE_*
  std::vector<CollectedMarker> markers;
};

struct CollectedJoint {
  std::string name;
  std::optional<double> position_m;
  std::optional<double> effort_N;
};

struct CollectedJoints {
  MessageTime time;
  std::vector<CollectedJoint> joints;
};

struct CollectedWrench {
  MessageTime time;
  std::string frame_id;
  Eigen::Vector3d force_N = Eigen::Vector3d::Zero();
  Eigen::Vector3d torque_Nm = Eigen::Vector3d::Zero();
};

struct CollectedPhase {
  MessageTime time;
  std::string text;
};

/// A stretch of the log with stamps of its own: recordings that were played one after the other may
/// each begin at 0.
struct Segment {
  std::string name;  ///< of the recording that was played; may be empty
  MessageTime first;
  MessageTime last;
};

/// All that the topics of an experiment hold but the pixels and points themselves.
struct CollectedTopics {
  std::vector<CollectedImage> depth;
  std::vector<CollectedImage> color;
  std::vector<CollectedImage> points;
  std::vector<CollectedInfo> infos;    ///< of all topics of camera information
  std::vector<CollectedSetup> setups;  ///< CameraSetup, or FrameInfo where there is none
  std::vector<CollectedMarkers> markers;
  std::vector<CollectedJoints> joints;
  std::vector<CollectedWrench> wrenches;
  std::vector<CollectedPhase> phases;
  std::vector<Segment> segments;  ///< by log time; empty: all is one
  TransformTree transforms;       ///< by log time
  /// p_robot = T p_camera, of the last /calibration that has one.
  std::optional<Eigen::Isometry3d> T_robot_camera;
  std::optional<geometry::PoseStandardError> T_robot_camera_error;
  float largest_range_m = 0.0f;                 ///< of 32-bit depth, up to kFarthest_m
  bool ranges_are_millimetres = true;           ///< all 32-bit depth is whole millimetres
  bool has_ranges = false;                      ///< depth is 32-bit
  std::map<std::string, std::size_t> left_out;  ///< "TOPIC: why", messages
};

/// Depth beyond is left out of 32-bit images, so that 16 bits resolve 0.1 mm.
inline constexpr float kFarthest_m = 6.5535f;

CollectedTopics CollectTopics(const recording::RecordedMessages& recorded, const TopicRoles& roles);

}  // namespace palpate::offline
