// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string_view>
#include <vector>

#include "diagnostic_msgs/msg/DiagnosticArray.hpp"
#include "geometry_msgs/msg/WrenchStamped.hpp"
#include "palpate_msgs/msg/BenchState.hpp"
#include "palpate_msgs/msg/Calibration.hpp"
#include "palpate_msgs/msg/CalibrationRequest.hpp"
#include "palpate_msgs/msg/CalibrationStatus.hpp"
#include "palpate_msgs/msg/CameraSetup.hpp"
#include "palpate_msgs/msg/ClockExchange.hpp"
#include "palpate_msgs/msg/ComponentStatus.hpp"
#include "palpate_msgs/msg/ContactArray.hpp"
#include "palpate_msgs/msg/ForceArray.hpp"
#include "palpate_msgs/msg/FrameInfo.hpp"
#include "palpate_msgs/msg/MarkerArray3.hpp"
#include "palpate_msgs/msg/Mesh.hpp"
#include "palpate_msgs/msg/MeshState.hpp"
#include "palpate_msgs/msg/ModelGap.hpp"
#include "palpate_msgs/msg/PerceptionReport.hpp"
#include "palpate_msgs/msg/WrenchArray.hpp"
#include "rcl_interfaces/msg/Log.hpp"
#include "rosgraph_msgs/msg/Clock.hpp"
#include "sensor_msgs/msg/CameraInfo.hpp"
#include "sensor_msgs/msg/Image.hpp"
#include "sensor_msgs/msg/JointState.hpp"
#include "sensor_msgs/msg/PointCloud2.hpp"
#include "std_msgs/msg/String.hpp"
#include "tf2_msgs/msg/TFMessage.hpp"

namespace palpate::dds {

/// A topic that code may read or write: its ROS name in the topic table and its type. Participant
/// makes endpoints of these only, so no topic can be used that is not in the table.
template <typename T>
struct Topic {
  std::string_view name;
};

inline constexpr Topic<idl::sensor_msgs::Image> kDepthImageTopic{"/camera/depth/image_raw"};
inline constexpr Topic<idl::sensor_msgs::CameraInfo> kDepthCameraInfoTopic{
    "/camera/depth/camera_info"};
inline constexpr Topic<idl::sensor_msgs::Image> kColorImageTopic{"/camera/color/image_raw"};
inline constexpr Topic<idl::sensor_msgs::CameraInfo> kColorCameraInfoTopic{
    "/camera/color/camera_info"};
inline constexpr Topic<idl::palpate_msgs::FrameInfo> kFrameInfoTopic{"/camera/frame_info"};
inline constexpr Topic<idl::palpate_msgs::CameraSetup> kCameraSetupTopic{"/camera/setup"};
inline constexpr Topic<idl::palpate_msgs::MarkerArray3> kMarkersTopic{"/perception/markers"};
/// The robot's points and those of objects near it, camera frame; at most 200 kB each.
inline constexpr Topic<idl::sensor_msgs::PointCloud2> kRobotCloudTopic{"/perception/robot_cloud"};
inline constexpr Topic<idl::sensor_msgs::PointCloud2> kObjectCloudTopic{"/perception/object_cloud"};
inline constexpr Topic<idl::palpate_msgs::PerceptionReport> kPerceptionReportTopic{
    "/perception/report"};
/// The last of a frame's four.
inline constexpr Topic<idl::palpate_msgs::ContactArray> kContactsTopic{"/perception/contacts"};
inline constexpr Topic<idl::sensor_msgs::JointState> kJointStatesTopic{"/robot/joint_states"};
/// Commands to the actuators: name = cable, position = displacement in m (NaN: cable free).
inline constexpr Topic<idl::sensor_msgs::JointState> kRobotCommandTopic{"/robot/command"};
inline constexpr Topic<idl::palpate_msgs::ForceArray> kForcesTopic{"/forces"};
/// <name>: a given contact's, else a slot's (slot_1, slot_2, ...).
inline constexpr Topic<idl::geometry_msgs::WrenchStamped> kWrenchTopic{"/forces/<name>/wrench"};
/// All of them, under a name that is known beforehand.
inline constexpr Topic<idl::palpate_msgs::WrenchArray> kWrenchesTopic{"/forces/wrenches"};
inline constexpr Topic<idl::palpate_msgs::MeshState> kMeshStateTopic{"/robot/mesh_state"};
inline constexpr Topic<idl::palpate_msgs::Mesh> kMeshTopic{"/robot/mesh"};
inline constexpr Topic<idl::palpate_msgs::ModelGap> kModelGapTopic{"/model_gap"};
/// What the last calibration found; stays there for late joiners.
inline constexpr Topic<idl::palpate_msgs::Calibration> kCalibrationTopic{"/calibration"};
inline constexpr Topic<idl::palpate_msgs::CalibrationRequest> kCalibrationRequestTopic{
    "/calibration/request"};
inline constexpr Topic<idl::palpate_msgs::CalibrationStatus> kCalibrationStatusTopic{
    "/calibration/status"};
/// The virtual bench's own; no estimator may read them.
inline constexpr Topic<idl::palpate_msgs::ForceArray> kTrueForcesTopic{"/truth/forces"};
inline constexpr Topic<idl::palpate_msgs::Mesh> kTrueMeshTopic{"/truth/mesh"};
inline constexpr Topic<idl::palpate_msgs::MeshState> kTrueMeshStateTopic{"/truth/mesh_state"};
inline constexpr Topic<idl::palpate_msgs::BenchState> kBenchStateTopic{"/truth/bench_state"};
inline constexpr Topic<idl::palpate_msgs::ComponentStatus> kComponentStatusTopic{
    "/component_status"};
/// Times of all processes, to measure the offsets between the clocks of hosts.
inline constexpr Topic<idl::palpate_msgs::ClockExchange> kClockExchangeTopic{"/clock_exchange"};
inline constexpr Topic<idl::diagnostic_msgs::DiagnosticArray> kDiagnosticsTopic{"/diagnostics"};
inline constexpr Topic<idl::rcl_interfaces::Log> kRosoutTopic{"/rosout"};
/// What nodes with use_sim_time take for now.
inline constexpr Topic<idl::rosgraph_msgs::Clock> kClockTopic{"/clock"};
inline constexpr Topic<idl::tf2_msgs::TFMessage> kTfStaticTopic{"/tf_static"};
/// What is done in a recording, and known loads: users publish them (docs/experiment.md).
inline constexpr Topic<idl::std_msgs::String> kExperimentPhaseTopic{"/experiment/phase"};
inline constexpr Topic<idl::geometry_msgs::WrenchStamped> kExperimentLoadTopic{"/experiment/load"};
/// The robot as URDF.
inline constexpr Topic<idl::std_msgs::String> kRobotDescriptionTopic{"/robot_description"};

struct TopicNameAndType {
  std::string_view name;
  std::string_view dds_type;
  std::string_view type_information;  ///< structure of the type, hashed (XTypes 1.3, 7.6.3.2.2)
};

/// All of the above.
std::vector<TopicNameAndType> AllTopics();

}  // namespace palpate::dds
