// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "components/virtual_camera/virtual_camera.hpp"
#include "libs/core/status.hpp"
#include "libs/dds/topics.hpp"
#include "libs/scenario/schedule.hpp"

namespace palpate::virtual_camera {

/// Nodes and triangles of the robot_surface; its markers stay. kInvalidInput for another frame
/// than the robot's, numbers that do not make whole nodes or triangles, a node that does not exist,
/// positions that are not finite.
Status FromMesh(const idl::palpate_msgs::Mesh& message, RobotSurface* robot_surface);

/// Positions of the `node_count` nodes. kInvalidInput as above, or where the state is not ok.
Status FromMeshState(const idl::palpate_msgs::MeshState& message, Eigen::Index node_count,
                     View* view);

/// Tools, camera, recording and time on the bench's clock. kInvalidInput for a pose that is none,
/// or a recording that the scenario does not have.
Status FromBenchState(const idl::palpate_msgs::BenchState& message,
                      const scenario::Schedule& schedule, View* view);

}  // namespace palpate::virtual_camera
