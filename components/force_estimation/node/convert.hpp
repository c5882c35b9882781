// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <vector>

#include "components/force_estimation/node/frame_input.hpp"
#include "libs/dds/message.hpp"
#include "libs/dds/topics.hpp"
#include "libs/robot/robot_body.hpp"

namespace palpate::force_estimation {

FrameHead HeadOf(const idl::palpate_msgs::MarkerArray3& message,
                 std::chrono::steady_clock::time_point taken);

/// Markers in the order of `names`; those that the message does not hold are not valid. The cables
/// stay empty. kInvalidInput, with the reason, for another frame than the robot's, a marker that
/// is not among `names` (with "did you mean") or is named twice, a position that is not finite, and
/// an unknown reference shape.
Status FromMarkerArray(const idl::palpate_msgs::MarkerArray3& message,
                       const std::vector<std::string>& names, MarkerFrame* frame);

/// Perception's status of a frame of the camera.
Status StatusOfPerception(const idl::palpate_msgs::PerceptionReport& message);

/// Points of the robot's texture, camera frame. kInvalidInput for numbers that are not finite,
/// directions that are no unit vectors, and a sigma that is not above 0.
Status FromTexture(const idl::palpate_msgs::PerceptionReport& message,
                   rgbd::TexturePoints* texture);

/// Contacts of the camera frame, in the robot frame. kInvalidInput for numbers that are not finite.
Status FromContactArray(const idl::palpate_msgs::ContactArray& message,
                        const Eigen::Isometry3d& T_robot_camera,
                        std::vector<SeenContact>* contacts);

/// Without counter, age and latency. The numbers of an unobservable force are NaN.
dds::Message<idl::palpate_msgs::ForceArray> ToForceArray(const FrameHead& head,
                                                         const Status& status,
                                                         const std::vector<ContactForce>& contacts);

/// Torque about the origin of the robot frame.
dds::Message<idl::geometry_msgs::WrenchStamped> ToWrench(int64_t stamp_ns,
                                                         const ContactForce& contact);

struct ContactWrench {
  ContactForce contact;
  std::string topic;  ///< where it is a WrenchStamped; empty: nowhere
};

/// Without counter.
dds::Message<idl::palpate_msgs::WrenchArray> ToWrenchArray(
    int64_t stamp_ns, const std::vector<ContactWrench>& wrenches);

/// Without positions where the state is unknown.
dds::Message<idl::palpate_msgs::MeshState> ToMeshState(const FrameResult& result,
                                                       const std::string& mesh_hash);

dds::Message<idl::palpate_msgs::Mesh> ToMesh(const robot::RobotBody& body, int64_t stamp_ns);

/// URDF with one link, the robot frame, and the box about the body at rest: what RViz needs to know
/// the frame. A deformed body is on /robot/mesh_state.
dds::Message<idl::std_msgs::String> ToDescription(const robot::RobotBody& body);

dds::Message<idl::palpate_msgs::ModelGap> ToModelGap(const FrameResult& result);

/// Without positions: the answer to a frame that was not estimated.
dds::Message<idl::palpate_msgs::MeshState> NoMeshState(const FrameHead& head, const Status& status,
                                                       const std::string& mesh_hash);

}  // namespace palpate::force_estimation
