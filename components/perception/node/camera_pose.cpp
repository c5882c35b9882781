// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/node/camera_pose.hpp"

#include <utility>

#include "libs/dds/geometry_messages.hpp"

namespace palpate::perception {

Status CameraPose::Take(const idl::palpate_msgs::Calibration& message) {
  if (!message.has_camera) return Status::Ok();
  Told told{Eigen::Isometry3d::Identity(), std::string(dds::Text(message.mesh_hash)),
            std::string(dds::Text(message.date_utc))};
  if (!dds::FromPose(message.camera_in_robot, &told.T_robot_camera)) {
    return {StatusCode::kInvalidInput, "camera_in_robot is no pose"};
  }
  const std::string& last = told_ ? told_->date_utc : date_utc_;
  if (told.date_utc < last) {
    return {StatusCode::kStale,
            "it is of " + told.date_utc + ", older than the one in use, of " + last};
  }
  told_ = std::move(told);
  return Status::Ok();
}

Status CameraPose::Adopt(const std::string& mesh_hash) {
  if (!told_ || mesh_hash.empty()) return Status::Ok();
  const Told told = *std::exchange(told_, std::nullopt);
  if (told.mesh_hash != mesh_hash) {
    return {StatusCode::kInvalidInput, "the calibration is for mesh '" + told.mesh_hash +
                                           "', /robot/mesh is '" + mesh_hash + "'"};
  }
  T_robot_camera_ = told.T_robot_camera;
  date_utc_ = told.date_utc;
  return Status::Ok();
}

}  // namespace palpate::perception
