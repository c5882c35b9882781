// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/rgbd/rgbd_camera.hpp"

#include <algorithm>
#include <vector>

#include "libs/core/config_reader.hpp"
#include "libs/core/text.hpp"
#include "libs/geometry/pose_text.hpp"

namespace palpate::rgbd {

namespace {

constexpr int kLargestSize_px = 16384;
constexpr int kLargestDepthValue = 65535;
constexpr std::size_t kWithoutK3 = 4;
// A unit of 1 is one that was meant in millimetres, a baseline of 50 as well.
constexpr NumberRule kUnitRule{.min = 0.0, .max = 0.1, .min_open = true};
constexpr NumberRule kBaselineRule{.min = 0.0, .max = 2.0};

std::array<double, 5> ReadDistortion(const ConfigNode& node) {
  const std::vector<double> values = ReadNumbers(node);
  std::array<double, 5> distortion{};
  if (!values.empty() && values.size() != kWithoutK3 && values.size() != distortion.size()) {
    Refuse(node, "must be [k1, k2, p1, p2, k3], [k1, k2, p1, p2] or [], not a list of " +
                     std::to_string(values.size()));
  }
  std::copy(values.begin(), values.end(), distortion.begin());
  return distortion;
}

CameraModel ReadModel(MapReader& reader) {
  CameraModel model;
  model.width_px = ReadInteger(reader.Require("width_px"), 1, kLargestSize_px);
  model.height_px = ReadInteger(reader.Require("height_px"), 1, kLargestSize_px);
  model.fx_px = ReadNumber(reader.Require("fx_px"), kPositive);
  model.fy_px = ReadNumber(reader.Require("fy_px"), kPositive);
  model.cx_px = ReadNumber(reader.Require("cx_px"));
  model.cy_px = ReadNumber(reader.Require("cy_px"));
  if (const ConfigNode* node = reader.Optional("distortion")) {
    model.distortion = ReadDistortion(*node);
  }
  return model;
}

void ReadDepthCamera(const ConfigNode& node, RgbdCamera* camera) {
  MapReader reader(node);
  camera->depth = ReadModel(reader);
  camera->depth_unit_m = ReadNumber(reader.Require("unit_m"), kUnitRule);
  if (const ConfigNode* value = reader.Optional("invalid_value")) {
    camera->invalid_value = ReadInteger(*value, 0, kLargestDepthValue);
  }
  camera->baseline_m = reader.Number("baseline_m", 0.0, kBaselineRule);
  reader.Finish();
}

void ReadColorCamera(const ConfigNode& node, RgbdCamera* camera) {
  MapReader reader(node);
  camera->color = ReadModel(reader);
  if (const ConfigNode* value = reader.Optional("registered_to_depth")) {
    camera->color_registered = ReadBool(*value);
  }
  const ConfigNode* pose = reader.Optional("T_depth_color");
  if (pose != nullptr) {
    camera->T_depth_color = geometry::ReadPose(*pose);
  } else if (!camera->color_registered) {
    Refuse(node, "key 'T_depth_color' is missing, and the colour image is not registered_to_depth");
  }
  reader.Finish();
  if (camera->color_registered && !(camera->color == camera->depth)) {
    Refuse(node,
           "an image that is registered_to_depth has the size, focal length, centre and distortion "
           "of 'depth'");
  }
}

std::string FormatModel(const CameraModel& model) {
  const Eigen::Map<const Eigen::Matrix<double, 5, 1>> distortion(model.distortion.data());
  return "  width_px: " + std::to_string(model.width_px) + "\n" +
         "  height_px: " + std::to_string(model.height_px) + "\n" +
         "  fx_px: " + FormatNumber(model.fx_px) + "\n  fy_px: " + FormatNumber(model.fy_px) +
         "\n  cx_px: " + FormatNumber(model.cx_px) + "\n  cy_px: " + FormatNumber(model.cy_px) +
         "\n  distortion: " + geometry::FormatVector(distortion) + "\n";
}

}  // namespace

bool RgbdCamera::operator==(const RgbdCamera& other) const {
  return depth == other.depth && depth_unit_m == other.depth_unit_m &&
         invalid_value == other.invalid_value && baseline_m == other.baseline_m &&
         color == other.color && color_registered == other.color_registered &&
         T_depth_color.matrix() == other.T_depth_color.matrix();
}

RgbdCamera ReadCamera(MapReader& reader) {
  RgbdCamera camera;
  ReadDepthCamera(reader.Require("depth"), &camera);
  if (const ConfigNode* node = reader.Optional("color")) ReadColorCamera(*node, &camera);
  return camera;
}

RgbdCamera ReadCamera(const ConfigNode& node) {
  MapReader reader(node);
  RgbdCamera camera = ReadCamera(reader);
  reader.Finish();
  return camera;
}

RgbdCamera ReadCameraFile(const std::filesystem::path& file, const ConfigLoader& load) {
  return ReadCamera(load(file));
}

std::string FormatCameraFile(const RgbdCamera& camera) {
  std::string text = "depth:\n" + FormatModel(camera.depth) +
                     "  unit_m: " + FormatNumber(camera.depth_unit_m) + "\n" +
                     "  invalid_value: " + std::to_string(camera.invalid_value) + "\n" +
                     "  baseline_m: " + FormatNumber(camera.baseline_m) + "\n";
  if (camera.color.width_px == 0) return text;
  return text + "color:\n" + FormatModel(camera.color) +
         "  registered_to_depth: " + (camera.color_registered ? "true" : "false") + "\n" +
         "  T_depth_color: " + geometry::FormatPose(camera.T_depth_color) + "\n";
}

}  // namespace palpate::rgbd
