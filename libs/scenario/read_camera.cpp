// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <Eigen/Dense>
#include <numbers>

#include "libs/geometry/pose_text.hpp"
#include "libs/rgbd/rgbd_camera.hpp"
#include "libs/scenario/scenario_sections.hpp"

namespace palpate::scenario {

namespace {

constexpr NumberRule kShare{.min = 0.0, .max = 1.0};
constexpr NumberRule kCorrelation{.min = 0.0, .max = 1.0, .max_open = true};
constexpr NumberRule kGrazing{.min = 0.0, .max = std::numbers::pi / 2.0, .min_open = true};
constexpr NumberRule kFrameRateRule{.min = 0.0, .max = 1000.0, .min_open = true};
/// Nearer than this the eye sits in its target.
constexpr double kNearest_m = 1e-6;

DepthSensor ReadSensor(const ConfigNode& node) {
  const std::string word = ReadChoice(node, {"none", "stereo", "time_of_flight"});
  if (word == "none") return DepthSensor::kNone;
  return word == "stereo" ? DepthSensor::kStereo : DepthSensor::kTimeOfFlight;
}

Eigen::Isometry3d ReadLookAt(const ConfigNode& eye, const ConfigNode* target) {
  if (target == nullptr) Refuse(eye, "goes with 'target_m', the point that is looked at");
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
  MapReader reader(node);
  DepthNoise noise;
  const auto read = [&](const char* key, double* value, const NumberRule& rule) {
    *value = reader.Number(key, *value, rule);
  };
  if (const ConfigNode* sensor = reader.Optional("sensor")) noise.sensor = ReadSensor(*sensor);
  read("subpixel_px", &noise.subpixel_px, kNonNegative);
  read("correlation_px", &noise.correlation_px, {.min = 0.0, .max = 100.0});
  read("temporal_correlation", &noise.temporal_correlation, kCorrelation);
  read("disparity_step_px", &noise.disparity_step_px, kNonNegative);
  read("periodic_bias_px", &noise.periodic_bias_px, kNonNegative);
  read("low_frequency_bias", &noise.low_frequency_bias, {.min = 0.0, .max = 0.5});
  read("edge_hole_ratio", &noise.edge_hole_ratio, kShare);
  read("flying_pixel_ratio", &noise.flying_pixel_ratio, kShare);
  read("grazing_angle_rad", &noise.grazing_angle_rad, kGrazing);
  read("range_sigma_m", &noise.range_sigma_m, kNonNegative);
  reader.Finish();
  return noise;
}

CameraSpec ReadCameraSpec(const ConfigNode& node, const std::filesystem::path& folder,
                          const ConfigLoader& load) {
  MapReader reader(node);
  CameraSpec spec;
  if (const ConfigNode* file = reader.Optional("file")) {
    spec.camera = rgbd::ReadCameraFile((folder / ReadText(*file)).lexically_normal(), load);
  } else {
    spec.camera = rgbd::ReadCamera(reader);
  }
  const std::optional<Eigen::Isometry3d> pose = ReadCameraPose(reader);
  if (!pose) Refuse(node, "where is the camera? 'T_robot_camera', or 'eye_m' and 'target_m'");
  spec.T_robot_camera = *pose;
  spec.rate_hz = reader.Number("rate_hz", spec.rate_hz, kFrameRateRule);
  if (const ConfigNode* noise = reader.Optional("noise")) spec.noise = ReadDepthNoise(*noise);
  reader.Finish();
  if (spec.noise.sensor == DepthSensor::kStereo && spec.camera.baseline_m == 0.0) {
    Refuse(node, "the noise of a stereo camera needs its 'depth.baseline_m'");
  }
  return spec;
}

}  // namespace palpate::scenario
