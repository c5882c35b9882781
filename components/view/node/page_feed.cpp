// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/view/node/page_feed.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <span>
#include <utility>

#include "components/view/frames/binary_frame.hpp"
#include "components/view/frames/surface_residual.hpp"
#include "components/view/node/convert_images.hpp"
#include "libs/core/clock.hpp"
#include "libs/core/seconds.hpp"
#include "libs/dds/camera_messages.hpp"
#include "libs/dds/cloud_messages.hpp"
#include "libs/dds/geometry_messages.hpp"
#include "libs/dds/message.hpp"
#include "libs/dds/stamp.hpp"
#include "libs/geometry/frames.hpp"

namespace palpate::view {

namespace {

/// Faster streams are thinned to what a person sees.
constexpr double kMostShown_hz = 30.0;

double Now_s() { return NsToSeconds(MonotonicNow_ns()); }

std::vector<foxglove::SceneForce> SceneForcesOf(const idl::palpate_msgs::ForceArray& message) {
  std::vector<foxglove::SceneForce> forces;
  for (const auto& force : dds::Elements(message.forces)) {
    const Eigen::Vector3d force_N = dds::ToVector(force.force_n);
    const std::string name(dds::Text(force.name));
    forces.push_back({.label = force_N.allFinite() ? fmt::format("{}: {:.2f} +- {:.2f} N", name,
                                                                 force_N.norm(), force.ci95_n)
                                                   : name + ": unobservable",
                      .position_m = dds::ToVector(force.position_m),
                      .force_N = force_N});
  }
  return forces;
}

}  // namespace

PageFeed::PageFeed(const Config& config, int domain_id, KnownRobot* robot, FeedOutputs outputs)
    : config_(config),
      domain_id_(domain_id),
      robot_(robot),
      outputs_(std::move(outputs)),
      builder_(domain_id),
      probe_(config.probe, robot),
      color_limit_(config.images.max_rate_hz),
      depth_limit_(config.images.max_rate_hz),
      residual_limit_(config.residual.rate_hz),
      scene_limit_(config.foxglove.scene_rate_hz),
      cables_limit_(kMostShown_hz),
      paths_limit_(kMostShown_hz),
      markers_limit_(kMostShown_hz),
      segmentation_limit_(config.images.max_rate_hz) {}

double PageFeed::Count(const char* topic, std::optional<std::uint64_t> counter) {
  ++received_;
  const double now_s = Now_s();
  flows_[topic].Add(now_s, counter);
  return now_s;
}

void PageFeed::Warn(const char* topic, const Status& status) {
  ++refused_;
  outputs_.warn(std::string(topic) + " is not shown: " + status.message());
}

void PageFeed::Take(const idl::palpate_msgs::Mesh& message) {
  Count("/robot/mesh", std::nullopt);
  const Status taken = mesh_.Take(message);
  if (!taken.ok()) return Warn("/robot/mesh", taken);
  TellMesh();
}

void PageFeed::TakeTruth(const idl::palpate_msgs::Mesh& message) {
  Count("/truth/mesh", std::nullopt);
  const Status taken = truth_mesh_.Take(message);
  if (!taken.ok()) return Warn("/truth/mesh", taken);
  outputs_.publish(truth_mesh_.MeshMessage({}));
}

void PageFeed::TellMesh() {
  if (mesh_.surface().empty()) return;
  outputs_.publish(mesh_.MeshMessage(robot_ == nullptr ? std::vector<float>()
                                                       : robot_->Stiffness_Pa(mesh_.surface())));
}

/// Of a mesh that is the robot file's the cables are drawn along the body as it is now.
void PageFeed::TellCables() {
  if (robot_ == nullptr || robot_->model().CableCount() == 0) return;
  const bool is_its_mesh = mesh_.surface().hash == robot_->body().mesh_hash &&
                           mesh_.surface().node_count == robot_->NodeCount();
  if (!is_its_mesh || !mesh_.usable() || !paths_limit_.Pass(MonotonicNow_ns())) return;
  BinaryFrame frame("cable_paths", {{"robot", robot_->body().name}});
  for (const auto& [name, path_m] : robot_->CablePaths(mesh_.nodes_m())) {
    frame.Add(name, std::span(path_m.data(), static_cast<std::size_t>(path_m.size())));
  }
  outputs_.publish(BinaryMessage("cable_paths", frame.Bytes()));
}

void PageFeed::TellFixedNodes() {
  if (robot_ == nullptr) return;
  const Eigen::Matrix3Xf points_m = robot_->FixedSurfaceNodes_m();
  BinaryFrame frame("fixed_nodes", {{"robot", robot_->body().name}});
  frame.Add("points_m", std::span(points_m.data(), static_cast<std::size_t>(points_m.size())));
  outputs_.publish(BinaryMessage("fixed_nodes", frame.Bytes()));
}

void PageFeed::Take(const idl::palpate_msgs::MeshState& message) {
  const double now_s = Count("/robot/mesh_state", message.counter);
  builder_.Add(message, now_s);
  const Status taken = mesh_.Take(message);
  if (!taken.ok()) return Warn("/robot/mesh_state", taken);
  std::vector<float> residual_m = Residual(MonotonicNow_ns());
  outputs_.publish(mesh_.StateMessage(residual_m));
  if (!residual_m.empty()) probe_.TakeResidual(std::move(residual_m));
  TellCables();
  TellScene();
}

void PageFeed::TakeTruth(const idl::palpate_msgs::MeshState& message) {
  Count("/truth/mesh_state", message.counter);
  const Status taken = truth_mesh_.Take(message);
  if (!taken.ok()) return Warn("/truth/mesh_state", taken);
  outputs_.publish(truth_mesh_.StateMessage({}));
}

void PageFeed::Take(const idl::palpate_msgs::ForceArray& message) {
  builder_.Add(message, Count("/forces", message.counter));
  forces_ = SceneForcesOf(message);
  outputs_.publish(ForcesMessage("forces", message));
}

void PageFeed::TakeTruth(const idl::palpate_msgs::ForceArray& message) {
  Count("/truth/forces", message.counter);
  outputs_.publish(ForcesMessage("truth_forces", message));
}

void PageFeed::Take(const idl::palpate_msgs::ModelGap& message) {
  builder_.Add(message, Count("/model_gap", message.counter));
  probe_.Take(message);
  outputs_.publish(ModelErrorMessage(message, judgement_));
}

void PageFeed::Take(const idl::palpate_msgs::PerceptionReport& message) {
  builder_.Add(message, Count("/perception/report", message.counter));
}

void PageFeed::Take(const idl::palpate_msgs::FrameInfo& message) {
  builder_.Add(message, Count("/camera/frame_info", message.counter));
}

void PageFeed::Take(const idl::palpate_msgs::ComponentStatus& message) {
  builder_.Add(message, Now_s());
}

void PageFeed::Take(const idl::diagnostic_msgs::DiagnosticArray& message) {
  builder_.Add(message, Now_s());
}

void PageFeed::Take(const idl::sensor_msgs::JointState& message) {
  builder_.Add(message, Count("/robot/joint_states", std::nullopt));
  probe_.Take(message);
  if (cables_limit_.Pass(MonotonicNow_ns())) {
    outputs_.publish(CablesMessage(
        message, robot_ == nullptr ? std::vector<std::string>() : robot_->model().ChamberNames()));
  }
}

void PageFeed::Take(const idl::palpate_msgs::CalibrationStatus& message) {
  Count("/calibration/status", std::nullopt);
  builder_.Add(message);
  calibration_.Take(message);
  outputs_.publish(calibration_.Message());
}

void PageFeed::Take(const idl::palpate_msgs::Calibration& message) {
  Count("/calibration", std::nullopt);
  Eigen::Isometry3d T_robot_camera;
  if (message.has_camera && dds::FromPose(message.camera_in_robot, &T_robot_camera)) {
    T_robot_camera_ = T_robot_camera;
  }
  TakeModuli(message);
  calibration_.Take(message);
  outputs_.publish(calibration_.Message());
}

void PageFeed::TakeModuli(const idl::palpate_msgs::Calibration& message) {
  if (robot_ == nullptr || dds::Text(message.mesh_hash) != robot_->body().mesh_hash) return;
  bool changed = false;
  for (const auto& modulus : dds::Elements(message.moduli)) {
    const double youngs_modulus_Pa = modulus.youngs_modulus_pa;
    if (!std::isfinite(youngs_modulus_Pa) || youngs_modulus_Pa <= 0.0) continue;
    changed |= robot_->SetYoungsModulus(std::string(dds::Text(modulus.part)), youngs_modulus_Pa);
  }
  if (changed) TellMesh();
}

void PageFeed::Take(const idl::palpate_msgs::CameraSetup& message) {
  Count("/camera/setup", std::nullopt);
  if (std::isfinite(message.depth_unit_m) && message.depth_unit_m > 0.0) {
    depth_unit_m_ = message.depth_unit_m;
  }
}

void PageFeed::Take(const idl::tf2_msgs::TFMessage& message) {
  Count("/tf_static", std::nullopt);
  const Status taken = transforms_.Add(message);
  if (!taken.ok()) Warn("/tf_static", taken);
}

void PageFeed::TakeColorInfo(const idl::sensor_msgs::CameraInfo& message) {
  Count("/camera/color/camera_info", std::nullopt);
  rgbd::CameraModel color;
  const Status read = dds::FromCameraInfo(message, &color);
  if (!read.ok()) return Warn("/camera/color/camera_info", read);
  color_ = color;
  color_frame_ = dds::Text(message.header.frame_id);
}

/// By /tf_static, where perception says which pose it uses, else by /calibration.
std::optional<Eigen::Isometry3d> PageFeed::RobotFrom(const std::string& frame) const {
  const std::string robot(geometry::kRobotFrame);
  if (frame == robot) return Eigen::Isometry3d::Identity();
  if (const auto found = transforms_.Find(robot, frame)) return found;
  const bool is_camera = frame == geometry::kCameraDepthOpticalFrame;
  return is_camera ? T_robot_camera_ : std::nullopt;
}

void PageFeed::TakeCloud(const char* topic, const char* kind,
                         const idl::sensor_msgs::PointCloud2& message, Cloud* cloud) {
  Count(topic, std::nullopt);
  if (!outputs_.wants_clouds()) return;
  dds::JoinedCloud joined;
  const Status read = dds::FromJoinedPointCloud2(message, &joined);
  if (!read.ok()) return Warn(topic, read);
  cloud->cloud = std::move(joined.points);
  cloud->frame = dds::Text(message.header.frame_id);
  cloud->stamp_ns = dds::StampNs(message.header.stamp);
  const auto T_robot_cloud = RobotFrom(cloud->frame);
  if (!T_robot_cloud) {
    return Warn(topic, {StatusCode::kNoCalibration,
                        "no pose of '" + cloud->frame + "' on /tf_static or /calibration"});
  }
  TellCloud(kind, *cloud, *T_robot_cloud);
}

void PageFeed::TellCloud(const char* kind, const Cloud& cloud,
                         const Eigen::Isometry3d& T_robot_cloud) {
  const Eigen::Matrix3Xf points_m =
      (T_robot_cloud.linear().cast<float>() * cloud.cloud.points_m).colwise() +
      T_robot_cloud.translation().cast<float>();
  BinaryFrame frame(kind, {{"stamp_ns", std::to_string(cloud.stamp_ns)}});
  frame.Add("points_m", std::span(points_m.data(), static_cast<std::size_t>(points_m.size())));
  frame.Add("rgb", cloud.cloud.colors_rgb);
  outputs_.publish(BinaryMessage(kind, frame.Bytes()));
}

void PageFeed::TakePoints(const rgbd::SensedCloud& points, std::int64_t stamp_ns) {
  Count("points", std::nullopt);
  if (!outputs_.wants_clouds()) return;
  robot_cloud_ = {points, std::string(geometry::kRobotFrame), stamp_ns};
  TellCloud("robot_cloud", robot_cloud_, Eigen::Isometry3d::Identity());
}

void PageFeed::Take(const idl::palpate_msgs::MarkerArray3& message) {
  Count("/perception/markers", message.counter);
  if (!markers_limit_.Pass(MonotonicNow_ns())) return;
  ShownMarkers markers;
  const Status read = FromMarkerArray(message, &markers);
  if (!read.ok()) return Warn("/perception/markers", read);
  if (robot_ != nullptr && mesh_.usable() && mesh_.surface().node_count == robot_->NodeCount()) {
    markers.model_m = robot_->MarkersAt(markers.names, mesh_.nodes_m());
  }
  TakeMarkers(std::move(markers));
}

void PageFeed::TakeMarkers(ShownMarkers markers) {
  outputs_.publish(MarkersMessage(markers));
  probe_.Take(std::move(markers));
}

void PageFeed::TakeRobotCloud(const idl::sensor_msgs::PointCloud2& message) {
  TakeCloud("/perception/robot_cloud", "robot_cloud", message, &robot_cloud_);
}

/// Perception sends it after the robot's cloud of the same frame.
void PageFeed::TakeObjectCloud(const idl::sensor_msgs::PointCloud2& message) {
  TakeCloud("/perception/object_cloud", "object_cloud", message, &object_cloud_);
  TellSegmentation();
}

void PageFeed::TellSegmentation() {
  const bool complete = color_ && color_->fx_px > 0.0 && robot_cloud_.stamp_ns != 0 &&
                        robot_cloud_.stamp_ns == object_cloud_.stamp_ns;
  if (!complete || !outputs_.wants_images()) return;
  const auto T_color_cloud = color_frame_ == robot_cloud_.frame
                                 ? std::optional(Eigen::Isometry3d::Identity())
                                 : transforms_.Find(color_frame_, robot_cloud_.frame);
  if (!T_color_cloud || !segmentation_limit_.Pass(MonotonicNow_ns())) return;
  outputs_.publish(SegmentationMessage(robot_cloud_.cloud, object_cloud_.cloud, *T_color_cloud,
                                       *color_, robot_cloud_.stamp_ns));
}

void PageFeed::TakeColorImage(const idl::sensor_msgs::Image& message) {
  Count("/camera/color/image_raw", std::nullopt);
  if (!outputs_.wants_images() || !color_limit_.Pass(MonotonicNow_ns())) return;
  OutMessage out;
  const Status made = ColorImageMessage(message, config_.images, &out);
  if (!made.ok()) return Warn("/camera/color/image_raw", made);
  outputs_.publish(std::move(out));
}

void PageFeed::TakeDepthImage(const idl::sensor_msgs::Image& message) {
  Count("/camera/depth/image_raw", std::nullopt);
  if (!outputs_.wants_images() || !depth_limit_.Pass(MonotonicNow_ns())) return;
  OutMessage out;
  const Status made = DepthImageMessage(message, depth_unit_m_, config_.images, &out);
  if (!made.ok()) return Warn("/camera/depth/image_raw", made);
  outputs_.publish(std::move(out));
}

void PageFeed::TakePackedColor(const idl::sensor_msgs::CompressedImage& message) {
  constexpr const char* kTopic = "/camera/color/image_raw/compressed";
  Count(kTopic, std::nullopt);
  if (!outputs_.wants_images() || !color_limit_.Pass(MonotonicNow_ns())) return;
  OutMessage out;
  const Status made = PackedColorMessage(message, config_.images, &out);
  if (!made.ok()) return Warn(kTopic, made);
  outputs_.publish(std::move(out));
}

void PageFeed::TakePackedDepth(const idl::sensor_msgs::CompressedImage& message) {
  constexpr const char* kTopic = "/camera/depth/image_raw/compressedDepth";
  Count(kTopic, std::nullopt);
  if (!outputs_.wants_images() || !depth_limit_.Pass(MonotonicNow_ns())) return;
  OutMessage out;
  const Status made = PackedDepthMessage(message, depth_unit_m_, config_.images, &out);
  if (!made.ok()) return Warn(kTopic, made);
  outputs_.publish(std::move(out));
}

std::vector<float> PageFeed::Residual(std::int64_t now_ns) {
  // A cloud of another frame would show the motion in between.
  constexpr double kMostApart_s = 0.1;
  const double apart_s = std::abs(NsToSeconds(mesh_.stamp_ns() - robot_cloud_.stamp_ns));
  if (!outputs_.wants_clouds() || !mesh_.usable() || apart_s > kMostApart_s) return {};
  const auto T_robot_cloud = RobotFrom(robot_cloud_.frame);
  if (!T_robot_cloud || !residual_limit_.Pass(now_ns)) return {};
  const Eigen::Matrix3Xf points_m =
      (T_robot_cloud->linear().cast<float>() * robot_cloud_.cloud.points_m).colwise() +
      T_robot_cloud->translation().cast<float>();
  return SurfaceResidual(mesh_.positions_m(), mesh_.surface().triangles, points_m,
                         static_cast<float>(config_.residual.radius_m));
}

void PageFeed::TellScene() {
  if (!outputs_.wants_scene() || !mesh_.usable() || !scene_limit_.Pass(MonotonicNow_ns())) return;
  outputs_.publish_scene(
      foxglove::RobotSceneJson(mesh_.surface(), mesh_.positions_m(), forces_, mesh_.stamp_ns()),
      mesh_.stamp_ns());
}

monitor::SystemSnapshot PageFeed::TellHealth(std::int64_t time_ns) {
  const double now_s = Now_s();
  monitor::SystemSnapshot snapshot = builder_.At(now_s, time_ns);
  judgement_ = snapshot.model_error ? snapshot.model_error->judgement : std::string();
  std::vector<TopicState> topics;
  for (const auto& [name, flow] : flows_) topics.push_back({name, flow.At(now_s)});
  outputs_.publish(HealthMessage(snapshot, topics));
  return snapshot;
}

void PageFeed::Forget() {
  robot_cloud_ = {};
  object_cloud_ = {};
  forces_.clear();
  probe_.Forget();
  // Processes whose uptime goes back have not restarted: another place of the recording is shown.
  builder_ = monitor::SnapshotBuilder(domain_id_);
  flows_.clear();
}

}  // namespace palpate::view
