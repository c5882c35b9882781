// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "libs/core/status.hpp"
#include "libs/dds/further_cameras.hpp"
#include "libs/dds/topics.hpp"

namespace palpate::perception {

/// Names of the cameras beside the first that a calibration holds.
std::vector<std::string> FurtherCamerasOf(const idl::palpate_msgs::Calibration& message);

/// Which calibration file poses at the start are of.
struct PoseOrigin {
  std::string mesh_hash;  ///< empty: of the settings
  std::string date_utc;
};

/// Poses of the depth cameras in the robot frame: those of the start until a calibration comes.
class CameraPose {
 public:
  /// `T_robot_camera`: of the first camera; `further`: those beside it, each with its pose.
  explicit CameraPose(std::optional<Eigen::Isometry3d> T_robot_camera,
                      std::vector<dds::FurtherCamera> further = {}, PoseOrigin origin = {})
      : T_robot_camera_(std::move(T_robot_camera)),
        further_(std::move(further)),
        start_mesh_hash_(std::move(origin.mesh_hash)),
        date_utc_(std::move(origin.date_utc)) {}

  /// nullopt: unknown.
  const std::optional<Eigen::Isometry3d>& T_robot_camera() const { return T_robot_camera_; }
  /// Those beside the first, by name.
  const std::vector<dds::FurtherCamera>& further() const { return further_; }

  /// Where transforms of ROS 2 have the camera. Taken where no other pose is known. kInvalidInput
  /// once it has moved from where it was then: every frame is of a camera at rest.
  Status FollowFrames(const Eigen::Isometry3d& T_robot_camera, const std::string& frame);
  /// Whether the pose in use is that of the transforms.
  bool is_of_frames() const { return of_frames_ && date_utc_.empty(); }

  /// One without a pose changes nothing. kInvalidInput for a pose that is none, kStale for one
  /// older than the one in use, kNoCalibration where a further camera is missing in it: none moves
  /// alone. It holds once Adopt has found that it is this robot's.
  Status Take(const idl::palpate_msgs::Calibration& message);
  /// With the mesh of the robot that is there, empty: it has not come yet. kInvalidInput where what
  /// was taken is another one's, or, once, the file of the start is: its poses stay.
  Status Adopt(const std::string& mesh_hash);

 private:
  struct Received {
    Eigen::Isometry3d T_robot_camera;
    std::vector<dds::FurtherCamera> further;
    std::string mesh_hash, date_utc;
  };

  Status ReadFurther(const idl::palpate_msgs::Calibration& message,
                     std::vector<dds::FurtherCamera>* cameras) const;

  std::optional<Eigen::Isometry3d> T_robot_camera_;
  std::vector<dds::FurtherCamera> further_;
  std::string start_mesh_hash_;                 ///< that Adopt has not compared yet
  std::optional<Eigen::Isometry3d> of_frames_;  ///< as it was taken
  std::optional<Received> received_;            ///< waits for the mesh
  std::string date_utc_;                        ///< of the calibration in use; empty: none
};

}  // namespace palpate::perception
