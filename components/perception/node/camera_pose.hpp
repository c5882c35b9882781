// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <utility>

#include "libs/core/status.hpp"
#include "libs/dds/topics.hpp"

namespace palpate::perception {

/// Pose of the depth camera in the robot frame: that of the settings until a calibration comes.
class CameraPose {
 public:
  explicit CameraPose(std::optional<Eigen::Isometry3d> T_robot_camera)
      : T_robot_camera_(std::move(T_robot_camera)) {}

  /// nullopt: unknown.
  const std::optional<Eigen::Isometry3d>& T_robot_camera() const { return T_robot_camera_; }

  /// Where transforms of ROS 2 have the camera. Taken where no other pose is known. kInvalidInput
  /// once it has moved from where it was then: every frame is of a camera at rest.
  Status FollowFrames(const Eigen::Isometry3d& T_robot_camera, const std::string& frame);
  /// Whether the pose in use is that of the transforms.
  bool is_of_frames() const { return of_frames_ && date_utc_.empty(); }

  /// One without a pose changes nothing. kInvalidInput for a pose that is none, kStale for one
  /// older than the one in use. It holds once Adopt has found that it is this robot's.
  Status Take(const idl::palpate_msgs::Calibration& message);
  /// With the mesh of the robot that is there, empty: it has not come yet. kInvalidInput where what
  /// was taken is another one's.
  Status Adopt(const std::string& mesh_hash);

 private:
  struct Received {
    Eigen::Isometry3d T_robot_camera;
    std::string mesh_hash, date_utc;
  };

  std::optional<Eigen::Isometry3d> T_robot_camera_;
  std::optional<Eigen::Isometry3d> of_frames_;  ///< as it was taken
  std::optional<Received> received_;            ///< waits for the mesh
  std::string date_utc_;                        ///< of the calibration in use; empty: none
};

}  // namespace palpate::perception
