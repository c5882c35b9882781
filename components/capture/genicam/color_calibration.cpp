// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/capture/genicam/color_calibration.hpp"

#include <cmath>
#include <cstddef>

namespace palpate::capture {

namespace {

constexpr double kGreatestDistortion = 10.0;
constexpr double kGreatestDistance_m = 10.0;

/// One number for each entry of a selector; nothing where one is missing or too large.
template <std::size_t n>
std::optional<std::array<double, n>> ReadList(Features& features, const std::string& name,
                                              const std::array<const char*, n>& entries,
                                              double greatest) {
  std::array<double, n> values{};
  for (std::size_t i = 0; i < n; ++i) {
    if (!Select(features, name + "Selector", entries[i])) return std::nullopt;
    const auto value = features.Number(name);
    if (!value || !(std::abs(*value) <= greatest)) return std::nullopt;
    values[i] = *value;
  }
  return values;
}

rgbd::Distortion ReadDistortion(Features& features, const std::string& name) {
  const auto values = ReadList<std::tuple_size_v<rgbd::Distortion>>(
      features, name, {"K1", "K2", "P1", "P2", "K3", "K4", "K5", "K6"}, kGreatestDistortion);
  return values.value_or(rgbd::Distortion{});
}

std::optional<Eigen::Isometry3d> ReadPose(Features& features) {
  const auto values = ReadList<7>(features, "PalpateDepthColor",
                                  {"Tx", "Ty", "Tz", "Qx", "Qy", "Qz", "Qw"}, kGreatestDistance_m);
  if (!values) return std::nullopt;
  const auto& v = *values;
  Eigen::Quaterniond rotation(v[6], v[3], v[4], v[5]);
  if (std::abs(rotation.norm() - 1.0) > 1e-3) return std::nullopt;
  Eigen::Isometry3d pose(rotation.normalized());
  pose.translation() = Eigen::Vector3d(v[0], v[1], v[2]);
  return pose;
}

bool Sound(const rgbd::CameraModel& model) {
  const auto focal = [](double f_px) { return f_px >= 50.0 && f_px <= 20000.0; };
  return focal(model.fx_px) && focal(model.fy_px) && std::abs(model.cx_px) < 30000.0 &&
         std::abs(model.cy_px) < 30000.0;
}

}  // namespace

ColorCalibration ReadColorCalibration(Features& features) {
  ColorCalibration calibration;
  rgbd::CameraModel model;
  model.fx_px = features.Number("PalpateColorFx").value_or(0.0);
  model.fy_px = features.Number("PalpateColorFy").value_or(0.0);
  model.cx_px = features.Number("PalpateColorCx").value_or(0.0);
  model.cy_px = features.Number("PalpateColorCy").value_or(0.0);
  if (!Sound(model)) return calibration;
  model.distortion = ReadDistortion(features, "PalpateColorDistortion");
  calibration.model = model;
  calibration.registered = features.Bool("PalpateColorRegistered");
  calibration.T_depth_color = ReadPose(features);
  return calibration;
}

rgbd::Distortion ReadDepthDistortion(Features& features) {
  return ReadDistortion(features, "PalpateDepthDistortion");
}

}  // namespace palpate::capture
