// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/virtual_camera/node/convert.hpp"

#include <algorithm>
#include <string>

#include "libs/dds/geometry_messages.hpp"
#include "libs/dds/stamp.hpp"
#include "libs/geometry/frames.hpp"

namespace palpate::virtual_camera {

namespace {

Status Refuse(std::string reason) { return {StatusCode::kInvalidInput, std::move(reason)}; }

Status CheckFrame(const idl::std_msgs::Header& header) {
  const std::string_view frame = dds::Text(header.frame_id);
  if (frame == geometry::kRobotFrame) return Status::Ok();
  return Refuse("frame '" + std::string(frame) + "' instead of 'robot'");
}

}  // namespace

Status FromMesh(const idl::palpate_msgs::Mesh& message, Skin* skin) {
  if (Status frame = CheckFrame(message.header); !frame.ok()) return frame;
  const auto& nodes = message.nodes_m;
  const auto& triangles = message.surface_triangles;
  if (nodes._length == 0 || nodes._length % 3 != 0 || triangles._length % 3 != 0) {
    return Refuse("a mesh of " + std::to_string(nodes._length) + " coordinates and " +
                  std::to_string(triangles._length) + " corners");
  }
  const auto node_count = static_cast<Eigen::Index>(nodes._length / 3);
  const Eigen::Map<const Eigen::Matrix3Xd> rest_m(nodes._buffer, 3, node_count);
  if (!rest_m.allFinite()) return Refuse("a node of the mesh is not finite");
  Eigen::Matrix3Xi corners(3, static_cast<Eigen::Index>(triangles._length / 3));
  for (std::uint32_t i = 0; i < triangles._length; ++i) {
    if (triangles._buffer[i] >= static_cast<std::uint32_t>(node_count)) {
      return Refuse("a triangle with node " + std::to_string(triangles._buffer[i]) + " of " +
                    std::to_string(node_count));
    }
    corners.data()[i] = static_cast<int>(triangles._buffer[i]);
  }
  skin->rest_m = rest_m;
  skin->triangles = std::move(corners);
  return Status::Ok();
}

Status FromMeshState(const idl::palpate_msgs::MeshState& message, Eigen::Index node_count,
                     View* view) {
  if (Status frame = CheckFrame(message.header); !frame.ok()) return frame;
  if (dds::Text(message.status) != "ok") {
    return Refuse("state '" + std::string(dds::Text(message.status)) + "'");
  }
  const auto& positions = message.positions_m;
  if (static_cast<Eigen::Index>(positions._length) != 3 * node_count) {
    return Refuse("a state of " + std::to_string(positions._length) + " coordinates for " +
                  std::to_string(node_count) + " nodes");
  }
  const Eigen::Map<const Eigen::Matrix3Xf> nodes_m(positions._buffer, 3, node_count);
  if (!nodes_m.allFinite()) return Refuse("a node of the state is not finite");
  view->nodes_m = nodes_m.cast<double>();
  return Status::Ok();
}

Status FromBenchState(const idl::palpate_msgs::BenchState& message,
                      const scenario::Schedule& schedule, View* view) {
  if (Status frame = CheckFrame(message.header); !frame.ok()) return frame;
  const std::size_t recordings = schedule.scenario().recordings.size();
  if (message.recording >= recordings) {
    return Refuse("recording " + std::to_string(message.recording) + " of " +
                  std::to_string(recordings));
  }
  if (!dds::FromPose(message.camera_in_robot, &view->T_robot_camera)) {
    return Refuse("the camera's pose is none");
  }
  view->tools.clear();
  for (const auto& tool : dds::Elements(message.tools)) {
    ToolPose pose{std::string(dds::Text(tool.name)), Eigen::Isometry3d::Identity()};
    if (!dds::FromPose(tool.pose, &pose.T_robot_tool)) {
      return Refuse("the pose of tool '" + pose.tool + "' is none");
    }
    view->tools.push_back(std::move(pose));
  }
  view->recording = static_cast<int>(message.recording);
  view->t_s = schedule.Begin_s(view->recording) + message.t_s;
  return Status::Ok();
}

}  // namespace palpate::virtual_camera
