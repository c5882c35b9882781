// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/node/camera_pose.hpp"

#include <utility>

#include "libs/dds/geometry_messages.hpp"

namespace palpate::perception {

Status CameraPose::Take(const idl::palpate_msgs::Calibration& message) {
  if (!message.has_camera) return Status::Ok();
  Received received{Eigen::Isometry3d::Identity(), std::string(dds::Text(message.mesh_hash)),
                    std::string(dds::Text(message.date_utc))};
  if (!dds::FromPose(message.camera_in_robot, &received.T_robot_camera)) {
    return {StatusCode::kInvalidInput, "camera_in_robot is no pose"};
  }
  const std::string& last = received_ ? received_->date_utc : date_utc_;
  if (received.date_utc < last) {
    return {StatusCode::kStale,
            "it is of " + received.date_utc + ", older than the one in use, of " + last};
  }
  received_ = std::move(received);
  return Status::Ok();
}

Status CameraPose::Adopt(const std::string& mesh_hash) {
  if (!received_ || mesh_hash.empty()) return Status::Ok();
  const Received received = *std::exchange(received_, std::nullopt);
  if (received.mesh_hash != mesh_hash) {
    return {StatusCode::kInvalidInput, "the calibration is for mesh '" + received.mesh_hash +
                                           "', /robot/mesh is '" + mesh_hash + "'"};
  }
  T_robot_camera_ = received.T_robot_camera;
  date_utc_ = received.date_utc;
  return Status::Ok();
}

}  // namespace palpate::perception
