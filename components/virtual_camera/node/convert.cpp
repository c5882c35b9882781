// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/virtual_camera/node/convert.hpp"

#include <string>

#include "libs/dds/geometry_messages.hpp"
#include "libs/dds/invalid_message.hpp"
#include "libs/dds/stamp.hpp"
#include "libs/geometry/frames.hpp"

namespace palpate::virtual_camera {

namespace {

using dds::Invalid;

Status CheckFrame(const idl::std_msgs::Header& header) {
  const std::string_view frame = dds::Text(header.frame_id);
  if (frame == geometry::kRobotFrame) return Status::Ok();
  return Invalid("frame '" + std::string(frame) + "' instead of 'robot'");
}

}  // namespace

Status FromMesh(const idl::palpate_msgs::Mesh& message, RobotSurface* robot_surface) {
  return dds::FromMesh(message, &robot_surface->rest_m, &robot_surface->triangles);
}

Status FromMeshState(const idl::palpate_msgs::MeshState& message, Eigen::Index node_count,
                     View* view) {
  if (dds::Text(message.status) != "ok") {
    return Invalid("state '" + std::string(dds::Text(message.status)) + "'");
  }
  Eigen::Matrix3Xf nodes_m;
  const Status status = dds::FromMeshState(message, node_count, &nodes_m);
  if (status.ok()) view->nodes_m = nodes_m.cast<double>();
  return status;
}

Status FromBenchState(const idl::palpate_msgs::BenchState& message,
                      const scenario::Schedule& schedule, View* view) {
  if (Status frame = CheckFrame(message.header); !frame.ok()) return frame;
  const std::size_t recordings = schedule.scenario().recordings.size();
  if (message.recording >= recordings) {
    return Invalid("recording " + std::to_string(message.recording) + " of " +
                   std::to_string(recordings));
  }
  if (!dds::FromPose(message.camera_in_robot, &view->T_robot_camera)) {
    return Invalid("the camera's pose is none");
  }
  view->tools.clear();
  for (const auto& tool : dds::Elements(message.tools)) {
    ToolPose pose{std::string(dds::Text(tool.name)), Eigen::Isometry3d::Identity()};
    if (!dds::FromPose(tool.pose, &pose.T_robot_tool)) {
      return Invalid("the pose of tool '" + pose.tool + "' is none");
    }
    view->tools.push_back(std::move(pose));
  }
  view->recording = static_cast<int>(message.recording);
  view->t_s = schedule.Begin_s(view->recording) + message.t_s;
  return Status::Ok();
}

}  // namespace palpate::virtual_camera
