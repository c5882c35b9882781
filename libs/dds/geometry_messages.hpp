// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <string>

#include "geometry_msgs/msg/Pose.hpp"
#include "libs/core/status.hpp"
#include "libs/dds/message.hpp"
#include "palpate_msgs/msg/Mesh.hpp"
#include "palpate_msgs/msg/MeshState.hpp"

namespace palpate::dds {

/// Fills Point and Vector3.
template <typename Target>
void SetVector(Target& target, const Eigen::Vector3d& source) {
  target.x = source.x();
  target.y = source.y();
  target.z = source.z();
}

/// A Point or Vector3 message.
template <typename Source>
Eigen::Vector3d ToVector(const Source& source) {
  return {source.x, source.y, source.z};
}

/// Pose of the body b in the frame a of the message: p_a = T_a_b * p_b.
idl::geometry_msgs::Pose ToPose(const Eigen::Isometry3d& T_a_b);
/// The quaternion is normalised. False, and nothing is set, where a number is not finite or the
/// quaternion's norm is off 1 by more than 1e-3.
[[nodiscard]] bool FromPose(const idl::geometry_msgs::Pose& pose, Eigen::Isometry3d* T_a_b);

/// A mesh at rest, in the robot frame.
struct MeshView {
  std::string robot;
  std::string mesh_hash;
  const Eigen::Matrix3Xd& nodes_m;
  const Eigen::MatrixXi& cells;  ///< [4 or 10 x m]
  Eigen::Matrix3Xi surface_triangles;
};
Message<idl::palpate_msgs::Mesh> ToMesh(const MeshView& mesh, std::int64_t stamp_ns);

/// Nodes at rest [3 x n] and triangles of the surface [3 x t]. kInvalidInput for another frame than
/// the robot's, numbers that do not make whole nodes or triangles, a node that does not exist,
/// positions that are not finite; then nothing is set.
Status FromMesh(const idl::palpate_msgs::Mesh& message, Eigen::Matrix3Xd* nodes_m,
                Eigen::Matrix3Xi* triangles);

/// Node positions [3n] in the robot frame, status ok.
Message<idl::palpate_msgs::MeshState> ToMeshState(const Eigen::VectorXd& x_m,
                                                  const std::string& mesh_hash,
                                                  std::int64_t stamp_ns);

/// Positions of the `node_count` nodes, whatever the status says. kInvalidInput as above.
Status FromMeshState(const idl::palpate_msgs::MeshState& message, Eigen::Index node_count,
                     Eigen::Matrix3Xf* nodes_m);

}  // namespace palpate::dds
