// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "libs/fem/mesh_io/node_group.hpp"
#include "libs/fem/tet_mesh.hpp"
#include "libs/robot/robot_description.hpp"

namespace palpate::robot {

/// The mesh of a robot, ready to solve on.
struct BodyMesh {
  fem::TetMesh mesh;                        ///< placed in the robot frame, of the robot's element
  std::string hash;                         ///< see RobotBody::mesh_hash
  std::vector<bool> used;                   ///< [n] whether an element names the node
  std::vector<fem::NodeGroup> node_groups;  ///< of the file, where a chamber names one
};

/// Reads, checks, places and, for tet10, refines the mesh. Appends to `notes`. Throws InputError.
BodyMesh ReadBodyMesh(const RobotDescription& robot, std::vector<std::string>* notes);

/// See RobotBody::mesh_hash; `mesh` as it lies in the file, `element` the one that is solved with.
std::string HashMesh(const fem::TetMesh& mesh, fem::ElementType element);

/// See RobotBody::fixed. Appends to `notes`. Throws InputError for a box without a node, and for a
/// piece of the mesh with no three held nodes that span a triangle.
Eigen::Matrix<bool, 3, Eigen::Dynamic> HoldNodes(const RobotDescription& robot,
                                                 const BodyMesh& body,
                                                 std::vector<std::string>* notes);

}  // namespace palpate::robot
