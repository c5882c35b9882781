// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/node/camera_pose.hpp"

#include <utility>

#include "libs/dds/geometry_messages.hpp"

namespace palpate::perception {

namespace {

/// Joints at rest move less than this, and camera poses are calibrated no better.
constexpr double kAtRest_m = 1e-3;
constexpr double kAtRest_rad = 2e-3;

bool HasMoved(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  const Eigen::Isometry3d motion = a.inverse() * b;
  return motion.translation().norm() > kAtRest_m ||
         Eigen::AngleAxisd(motion.linear()).angle() > kAtRest_rad;
}

}  // namespace

std::vector<std::string> FurtherCamerasOf(const idl::palpate_msgs::Calibration& message) {
  std::vector<std::string> names;
  for (const auto& camera : dds::Elements(message.cameras)) {
    names.emplace_back(dds::Text(camera.name));
  }
  return names;
}

Status CameraPose::FollowFrames(const Eigen::Isometry3d& T_robot_camera, const std::string& frame) {
  if (!T_robot_camera_) of_frames_ = T_robot_camera_ = T_robot_camera;
  if (!of_frames_ || !HasMoved(*of_frames_, T_robot_camera)) return Status::Ok();
  return {StatusCode::kInvalidInput,
          "frame '" + frame +
              "' moves against 'robot' on /tf: a camera on a moving mount is not supported; hold "
              "it still, and start again where it then stands"};
}

Status CameraPose::Take(const idl::palpate_msgs::Calibration& message) {
  if (!message.has_camera) return Status::Ok();
  Received received{Eigen::Isometry3d::Identity(),
                    {},
                    std::string(dds::Text(message.mesh_hash)),
                    std::string(dds::Text(message.date_utc))};
  if (!dds::FromPose(message.camera_in_robot, &received.T_robot_camera)) {
    return {StatusCode::kInvalidInput, "camera_in_robot is no pose"};
  }
  if (Status status = ReadFurther(message, &received.further); !status.ok()) return status;
  const std::string& last = received_ ? received_->date_utc : date_utc_;
  if (received.date_utc < last) {
    return {StatusCode::kStale,
            "it is of " + received.date_utc + ", older than the one in use, of " + last};
  }
  received_ = std::move(received);
  return Status::Ok();
}

/// The poses of the further cameras in use, by name.
Status CameraPose::ReadFurther(const idl::palpate_msgs::Calibration& message,
                               std::vector<dds::FurtherCamera>* cameras) const {
  dds::CameraMatch match = dds::MatchCameras(dds::NamesOf(further_), FurtherCamerasOf(message));
  match.unknown.clear();
  if (!match.missing.empty()) return {StatusCode::kNoCalibration, Describe(match)};
  *cameras = further_;
  for (dds::FurtherCamera& camera : *cameras) {
    for (const auto& source : dds::Elements(message.cameras)) {
      if (dds::Text(source.name) != camera.name) continue;
      if (!dds::FromPose(source.camera_in_robot, &camera.T_robot_camera.emplace())) {
        return {StatusCode::kInvalidInput,
                "camera '" + camera.name + "': camera_in_robot is no pose"};
      }
    }
  }
  return Status::Ok();
}

Status CameraPose::Adopt(const std::string& mesh_hash) {
  if (mesh_hash.empty()) return Status::Ok();
  const std::string of_start = std::exchange(start_mesh_hash_, {});
  if (!received_) {
    if (of_start.empty() || of_start == mesh_hash) return Status::Ok();
    return {StatusCode::kInvalidInput, "the file of --calibration is for mesh '" + of_start +
                                           "', /robot/mesh is '" + mesh_hash + "'"};
  }
  const Received received = *std::exchange(received_, std::nullopt);
  if (received.mesh_hash != mesh_hash) {
    return {StatusCode::kInvalidInput, "the calibration is for mesh '" + received.mesh_hash +
                                           "', /robot/mesh is '" + mesh_hash + "'"};
  }
  T_robot_camera_ = received.T_robot_camera;
  further_ = received.further;
  date_utc_ = received.date_utc;
  return Status::Ok();
}

}  // namespace palpate::perception
