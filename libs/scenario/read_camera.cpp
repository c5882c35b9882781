// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <Eigen/Dense>

#include "libs/geometry/pose_text.hpp"
#include "libs/rgbd/rgbd_camera.hpp"
#include "libs/scenario/scenario_sections.hpp"

namespace palpate::scenario {

namespace {

/// Nearer than this the eye sits in its target.
constexpr double kNearest_m = 1e-6;

DepthSensor ReadSensor(MapReader& reader) {
  std::string word = "stereo";
  reader.Read("sensor", &word);
  if (word == "none") return DepthSensor::kNone;
  return word == "stereo" ? DepthSensor::kStereo : DepthSensor::kTimeOfFlight;
}

Eigen::Isometry3d ReadLookAt(const ConfigNode& eye, const ConfigNode* target) {
  if (target == nullptr) Refuse(eye, "goes with 'target_m', the point on the optical axis");
  const Eigen::Vector3d eye_m = ReadVector3(eye);
  const Eigen::Vector3d target_m = ReadVector3(*target);
  if ((target_m - eye_m).norm() < kNearest_m) Refuse(*target, "is where the camera is");
  return LookAt(eye_m, target_m);
}

}  // namespace

Eigen::Isometry3d LookAt(const Eigen::Vector3d& eye_m, const Eigen::Vector3d& target_m) {
  const Eigen::Vector3d z = (target_m - eye_m).normalized();
  Eigen::Vector3d x = z.cross(Eigen::Vector3d::UnitZ());
  if (x.norm() < kNearest_m) x = Eigen::Vector3d::UnitX() - z.x() * z;
  x.normalize();
  Eigen::Isometry3d T_robot_camera = Eigen::Isometry3d::Identity();
  T_robot_camera.linear() << x, z.cross(x), z;
  T_robot_camera.translation() = eye_m;
  return T_robot_camera;
}

std::optional<Eigen::Isometry3d> ReadCameraPose(MapReader& reader) {
  const ConfigNode* pose = reader.Optional("T_robot_camera");
  const ConfigNode* eye = reader.Optional("eye_m");
  const ConfigNode* target = reader.Optional("target_m");
  const ConfigNode* other = eye != nullptr ? eye : target;
  if (pose != nullptr && other != nullptr) {
    Refuse(*other, "the camera's pose is given twice, by 'T_robot_camera' as well");
  }
  if (pose != nullptr) return geometry::ReadPose(*pose);
  if (eye != nullptr) return ReadLookAt(*eye, target);
  if (target != nullptr) Refuse(*target, "goes with 'eye_m', the point where the camera is");
  return std::nullopt;
}

DepthNoise ReadDepthNoise(const ConfigNode& node) {
  MapReader reader(node, DepthNoiseKeys());
  DepthNoise noise;
  noise.sensor = ReadSensor(reader);
  reader.Read("subpixel_px", &noise.subpixel_px);
  reader.Read("correlation_px", &noise.correlation_px);
  reader.Read("temporal_correlation", &noise.temporal_correlation);
  reader.Read("disparity_step_px", &noise.disparity_step_px);
  reader.Read("periodic_bias_px", &noise.periodic_bias_px);
  reader.Read("low_frequency_bias", &noise.low_frequency_bias);
  reader.Read("edge_hole_ratio", &noise.edge_hole_ratio);
  reader.Read("flying_pixel_ratio", &noise.flying_pixel_ratio);
  reader.Read("grazing_angle_rad", &noise.grazing_angle_rad);
  reader.Read("range_sigma_m", &noise.range_sigma_m);
  reader.Finish();
  return noise;
}

namespace {

/// The keys that every camera has; `node` is the map of `reader`.
CameraSpec ReadSpec(const ConfigNode& node, const ConfigLoader& load, MapReader& reader) {
  CameraSpec spec;
  std::filesystem::path file;
  reader.Read("file", &file);
  if (!file.empty()) {
    spec.camera = rgbd::ReadCameraFile(file, load);
  } else {
    spec.camera = rgbd::ReadCamera(reader);
  }
  const std::optional<Eigen::Isometry3d> pose = ReadCameraPose(reader);
  if (!pose) Refuse(node, "where is the camera? 'T_robot_camera', or 'eye_m' and 'target_m'");
  spec.T_robot_camera = *pose;
  reader.Read("rate_hz", &spec.rate_hz);
  if (const ConfigNode* noise = reader.Optional("noise")) spec.noise = ReadDepthNoise(*noise);
  if (spec.noise.sensor == DepthSensor::kStereo && spec.camera.baseline_m == 0.0) {
    Refuse(node, "the noise of a stereo camera needs its 'depth.baseline_m'");
  }
  return spec;
}

}  // namespace

CameraSpec ReadCameraSpec(const ConfigNode& node, const ConfigLoader& load) {
  MapReader reader(node, CameraSpecKeys());
  CameraSpec spec = ReadSpec(node, load, reader);
  reader.Finish();
  return spec;
}

std::vector<FurtherCamera> ReadFurtherCameras(const ConfigNode& node, const ConfigLoader& load) {
  std::vector<FurtherCamera> cameras;
  for (const ConfigNode& item : ReadList(node, "{name, ...}")) {
    MapReader reader(item, FurtherCameraKeys());
    FurtherCamera camera;
    reader.Read("name", &camera.name);
    for (const FurtherCamera& other : cameras) {
      if (other.name == camera.name)
        Refuse(item, "the camera '" + camera.name + "' is there twice");
    }
    reader.Read("delay_s", &camera.delay_s);
    reader.Read("clock_offset_s", &camera.clock_offset_s);
    static_cast<CameraSpec&>(camera) = ReadSpec(item, load, reader);
    reader.Finish();
    cameras.push_back(std::move(camera));
  }
  return cameras;
}

}  // namespace palpate::scenario
