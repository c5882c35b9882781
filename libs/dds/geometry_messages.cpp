// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/geometry_messages.hpp"

#include <cmath>
#include <string_view>
#include <utility>

#include "libs/core/index.hpp"
#include "libs/dds/invalid_message.hpp"
#include "libs/dds/stamp.hpp"
#include "libs/geometry/frames.hpp"

namespace palpate::dds {

namespace {

constexpr double kNormTolerance = 1e-3;

Status CheckFrame(const idl::std_msgs::Header& header) {
  const std::string_view frame = Text(header.frame_id);
  if (frame == geometry::kRobotFrame) return Status::Ok();
  return Invalid("frame '" + std::string(frame) + "' instead of 'robot'");
}

}  // namespace

idl::geometry_msgs::Pose ToPose(const Eigen::Isometry3d& T_a_b) {
  idl::geometry_msgs::Pose pose{};
  SetVector(pose.position, T_a_b.translation());
  const Eigen::Quaterniond rotation(T_a_b.linear());
  pose.orientation = {rotation.x(), rotation.y(), rotation.z(), rotation.w()};
  return pose;
}

bool FromPose(const idl::geometry_msgs::Pose& pose, Eigen::Isometry3d* T_a_b) {
  const Eigen::Vector3d translation_m(pose.position.x, pose.position.y, pose.position.z);
  const Eigen::Quaterniond rotation(pose.orientation.w, pose.orientation.x, pose.orientation.y,
                                    pose.orientation.z);
  if (!translation_m.allFinite() || !(std::abs(rotation.norm() - 1.0) <= kNormTolerance)) {
    return false;
  }
  T_a_b->setIdentity();
  T_a_b->linear() = rotation.normalized().toRotationMatrix();
  T_a_b->translation() = translation_m;
  return true;
}

Message<idl::palpate_msgs::Mesh> ToMesh(const MeshView& mesh, std::int64_t stamp_ns) {
  Message<idl::palpate_msgs::Mesh> message;
  SetHeader(message->header, stamp_ns, geometry::kRobotFrame);
  SetText(message->robot, mesh.robot);
  SetText(message->mesh_hash, mesh.mesh_hash);
  message->nodes_per_cell = static_cast<uint8_t>(mesh.cells.rows());
  SetText(message->element, mesh.cells.rows() == 4 ? "tet4" : "tet10");
  const Eigen::Matrix3Xi& triangles = mesh.surface_triangles;
  SetNumbers(message->nodes_m, mesh.nodes_m.data(), static_cast<size_t>(mesh.nodes_m.size()));
  SetNumbers(message->cells, mesh.cells.data(), static_cast<size_t>(mesh.cells.size()));
  SetNumbers(message->surface_triangles, triangles.data(), static_cast<size_t>(triangles.size()));
  return message;
}

Status FromMesh(const idl::palpate_msgs::Mesh& message, Eigen::Matrix3Xd* nodes_m,
                Eigen::Matrix3Xi* triangles) {
  if (Status frame = CheckFrame(message.header); !frame.ok()) return frame;
  const auto& nodes = message.nodes_m;
  const auto& corners = message.surface_triangles;
  if (nodes._length == 0 || nodes._length % 3 != 0 || corners._length % 3 != 0) {
    return Invalid("a mesh of " + std::to_string(nodes._length) + " coordinates and " +
                   std::to_string(corners._length) + " corners");
  }
  const auto node_count = ToIndex(nodes._length / 3);
  const Eigen::Map<const Eigen::Matrix3Xd> rest_m(nodes._buffer, 3, node_count);
  if (!rest_m.allFinite()) return Invalid("a node of the mesh is not finite");
  Eigen::Matrix3Xi numbers(3, ToIndex(corners._length / 3));
  for (std::uint32_t i = 0; i < corners._length; ++i) {
    if (corners._buffer[i] >= static_cast<std::uint32_t>(node_count)) {
      return Invalid("a triangle with node " + std::to_string(corners._buffer[i]) + " of " +
                     std::to_string(node_count));
    }
    numbers.data()[i] = static_cast<int>(corners._buffer[i]);
  }
  *nodes_m = rest_m;
  *triangles = std::move(numbers);
  return Status::Ok();
}

Message<idl::palpate_msgs::MeshState> ToMeshState(const Eigen::VectorXd& x_m,
                                                  const std::string& mesh_hash,
                                                  std::int64_t stamp_ns) {
  Message<idl::palpate_msgs::MeshState> message;
  SetHeader(message->header, stamp_ns, geometry::kRobotFrame);
  SetText(message->mesh_hash, mesh_hash);
  SetText(message->status, "ok");
  SetNumbers(message->positions_m, x_m.data(), static_cast<size_t>(x_m.size()));
  return message;
}

Status FromMeshState(const idl::palpate_msgs::MeshState& message, Eigen::Index node_count,
                     Eigen::Matrix3Xf* nodes_m) {
  if (Status frame = CheckFrame(message.header); !frame.ok()) return frame;
  const auto& positions = message.positions_m;
  if (ToIndex(positions._length) != 3 * node_count) {
    return Invalid("a state of " + std::to_string(positions._length) + " coordinates for " +
                   std::to_string(node_count) + " nodes");
  }
  const Eigen::Map<const Eigen::Matrix3Xf> positions_m(positions._buffer, 3, node_count);
  if (!positions_m.allFinite()) return Invalid("a node of the state is not finite");
  *nodes_m = positions_m;
  return Status::Ok();
}

}  // namespace palpate::dds
