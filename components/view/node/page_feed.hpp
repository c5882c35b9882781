// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "components/view/config.hpp"
#include "components/view/foxglove/robot_scene.hpp"
#include "components/view/frames/page_request.hpp"
#include "components/view/node/convert_texts.hpp"
#include "components/view/node/rate_limit.hpp"
#include "components/view/node/shown_markers.hpp"
#include "components/view/node/shown_mesh.hpp"
#include "components/view/node/skin_probe.hpp"
#include "libs/dds/transforms.hpp"
#include "libs/monitor/snapshot_builder.hpp"
#include "libs/rgbd/camera_model.hpp"
#include "libs/rgbd/sensed_cloud.hpp"
#include "sensor_msgs/msg/CompressedImage.hpp"

namespace palpate::view {

/// Where messages of the feed go, and what is wanted now.
struct FeedOutputs {
  std::function<void(OutMessage)> publish;
  std::function<bool()> wants_clouds;
  std::function<bool()> wants_images;
  /// A foxglove.SceneUpdate as JSON.
  std::function<void(std::string json, std::int64_t stamp_ns)> publish_scene;
  std::function<bool()> wants_scene;
  std::function<void(const std::string&)> warn;  ///< of a message that cannot be shown
};

/// Turns the messages of a system, running or recorded, into those of the page. Reads messages, but
/// joins no domain. From one thread.
class PageFeed {
 public:
  /// `robot`: null where it is not known; else it must outlive this.
  PageFeed(const Config& config, int domain_id, KnownRobot* robot, FeedOutputs outputs);

  void Take(const idl::palpate_msgs::Mesh& message);
  void Take(const idl::palpate_msgs::MeshState& message);
  void Take(const idl::palpate_msgs::ForceArray& message);
  void Take(const idl::palpate_msgs::ModelGap& message);
  void Take(const idl::palpate_msgs::PerceptionReport& message);
  void Take(const idl::palpate_msgs::FrameInfo& message);
  void Take(const idl::palpate_msgs::Calibration& message);
  void Take(const idl::palpate_msgs::CalibrationStatus& message);
  void Take(const idl::palpate_msgs::CameraSetup& message);
  void Take(const idl::palpate_msgs::ComponentStatus& message);
  void Take(const idl::diagnostic_msgs::DiagnosticArray& message);
  void Take(const idl::sensor_msgs::JointState& message);
  void Take(const idl::tf2_msgs::TFMessage& message);
  void Take(const idl::palpate_msgs::MarkerArray3& message);
  void TakeMarkers(ShownMarkers markers);
  /// Tells the page where the robot file holds the body.
  void TellFixedNodes();
  /// Points near the robot, in its frame.
  void TakePoints(const rgbd::SensedCloud& points, std::int64_t stamp_ns);
  void TakeRobotCloud(const idl::sensor_msgs::PointCloud2& message);
  void TakeObjectCloud(const idl::sensor_msgs::PointCloud2& message);
  void TakeColorImage(const idl::sensor_msgs::Image& message);
  void TakeDepthImage(const idl::sensor_msgs::Image& message);
  void TakePackedColor(const idl::sensor_msgs::CompressedImage& message);
  void TakePackedDepth(const idl::sensor_msgs::CompressedImage& message);
  void TakeColorInfo(const idl::sensor_msgs::CameraInfo& message);
  void TakeTruth(const idl::palpate_msgs::Mesh& message);
  void TakeTruth(const idl::palpate_msgs::MeshState& message);
  void TakeTruth(const idl::palpate_msgs::ForceArray& message);

  /// Once a second: the health message; returns the snapshot.
  monitor::SystemSnapshot TellHealth(std::int64_t time_ns);

  OutMessage Probe(const ProbeRequest& request) { return probe_.Answer(request, mesh_); }

  /// Counts and tells what cannot be shown.
  void Warn(const char* topic, const Status& status);

  /// Forgets what was shown: another place of a recording comes.
  void Forget();

  std::uint64_t received() const { return received_; }
  std::uint64_t refused() const { return refused_; }

 private:
  struct Cloud {
    rgbd::SensedCloud cloud;  ///< in the frame of its message
    std::string frame;
    std::int64_t stamp_ns = 0;
  };

  double Count(const char* topic, std::optional<std::uint64_t> counter);
  void TakeModuli(const idl::palpate_msgs::Calibration& message);
  void TellMesh();
  void TellCables();
  void TellCloud(const char* kind, const Cloud& cloud, const Eigen::Isometry3d& T_robot_cloud);
  void TakeCloud(const char* topic, const char* kind, const idl::sensor_msgs::PointCloud2& message,
                 Cloud* cloud);
  std::optional<Eigen::Isometry3d> RobotFrom(const std::string& frame) const;
  std::vector<float> Residual(std::int64_t now_ns);
  void TellScene();
  void TellSegmentation();

  Config config_;
  int domain_id_;
  KnownRobot* robot_;
  FeedOutputs outputs_;
  monitor::SnapshotBuilder builder_;
  std::map<std::string, monitor::FlowCounter> flows_;  ///< by topic
  ShownMesh mesh_{"mesh"};
  ShownMesh truth_mesh_{"truth_mesh"};
  SkinProbe probe_;
  std::vector<foxglove::SceneForce> forces_;
  dds::TransformTree transforms_;
  std::optional<Eigen::Isometry3d> T_robot_camera_;  ///< of /calibration
  std::optional<rgbd::CameraModel> color_;
  std::string color_frame_;
  double depth_unit_m_ = 1e-3;
  Cloud robot_cloud_;
  Cloud object_cloud_;
  std::string judgement_;
  ShownCalibration calibration_;
  RateLimit color_limit_;
  RateLimit depth_limit_;
  RateLimit residual_limit_;
  RateLimit scene_limit_;
  RateLimit cables_limit_;
  RateLimit paths_limit_;
  RateLimit markers_limit_;
  RateLimit segmentation_limit_;
  std::uint64_t received_ = 0;
  std::uint64_t refused_ = 0;
};

}  // namespace palpate::view
