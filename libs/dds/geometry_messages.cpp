// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/geometry_messages.hpp"

#include <cmath>

#include "libs/dds/stamp.hpp"
#include "libs/geometry/frames.hpp"

namespace palpate::dds {

namespace {

constexpr double kNormTolerance = 1e-3;

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

}  // namespace palpate::dds
