// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "components/perception/markers/fiducial.hpp"
#include "libs/core/status.hpp"
#include "libs/rgbd/rgbd_frame.hpp"
#include "libs/rgbd/sensed_cloud.hpp"
#include "libs/rgbd/texture_points.hpp"

namespace palpate::perception {

/// The robot's surface as the model predicts it: the last /robot/mesh_state.
struct PredictedSurface {
  Eigen::Matrix3Xd vertices_m;  ///< [3 x v] camera frame
  Eigen::Matrix3Xi triangles;   ///< [3 x t] anticlockwise from outside
};

/// Numbers of pixels or points that were left out, by reason.
struct Rejections {
  std::int64_t invalid_depth = 0;  ///< no depth value
  std::int64_t out_of_range = 0;   ///< PassThrough
  std::int64_t isolated = 0;       ///< RadiusOutlier, specks
  std::int64_t at_depth_edge = 0;  ///< mixed pixels
  std::int64_t ambiguous = 0;      ///< neither robot nor object by depth and colour
  std::int64_t thinned = 0;        ///< averaged into others to keep the clouds small
};

/// The frame's points, sorted. Where the status is not ok both clouds are empty.
struct SegmentedFrame {
  Status status;             ///< kNoRobotSeen, kInvalidInput with the reason
  rgbd::SensedCloud robot;   ///< camera frame; at most Config::max_cloud_points, each the mean of
  rgbd::SensedCloud object;  ///< neighbours, with the sigma of that mean; objects near the robot
  Rejections rejected;
  std::vector<std::string> notes;  ///< for the user, e.g. "the light has changed"
};

/// One contact between the robot and an object (Algorithm 2), camera frame.
struct DetectedContact {
  std::string name;  ///< the same over the frames: contact_1, contact_2, ...
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();     ///< mean of the contact points
  Eigen::Matrix3d covariance_m2 = Eigen::Matrix3d::Zero();  ///< of that position
  Eigen::Vector3d extent_m = Eigen::Vector3d::Zero();       ///< full size along the camera's axes
  int point_count = 0;
  int frames_seen = 0;  ///< in a row
};

/// What one camera shows in a frame.
struct CameraView {
  SegmentedFrame frame;
  FiducialFrame markers;        ///< kNotRun where Config::markers has no colour
  rgbd::TexturePoints texture;  ///< none where there is no colour, texture or predicted surface
};

/// Result of perception for one frame.
struct Observation : CameraView {
  std::int64_t stamp_ns = 0;              ///< of the frame
  std::vector<DetectedContact> contacts;  ///< by rising number
};

}  // namespace palpate::perception
