// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/rgbd/rgbd_camera.hpp"

#include <algorithm>
#include <tuple>
#include <vector>

#include "libs/core/config_reader.hpp"
#include "libs/core/index.hpp"
#include "libs/core/text.hpp"
#include "libs/geometry/pose_text.hpp"
#include "libs/rgbd/ros_camera_info.hpp"
#include "libs/rgbd/ros_formats.hpp"

namespace palpate::rgbd {

namespace {

constexpr int kLargestSize_px = 16384;
constexpr int kLargestDepthValue = 65535;
constexpr int kRational = std::tuple_size_v<Distortion>;
// A unit of 1 is one that was meant in millimetres, a baseline of 50 as well.
constexpr NumberRule kUnitRule{.min = 0.0, .max = 0.1, .min_open = true};
constexpr NumberRule kBaselineRule{.min = 0.0, .max = 2.0};

Distortion ReadDistortion(const ConfigNode& node) {
  const bool none = node.kind == ConfigNode::Kind::kScalar && node.text == "none";
  const std::vector<double> values = none ? std::vector<double>() : ReadNumbers(node);
  const auto distortion = DistortionOf(
      values.size() == std::tuple_size_v<Distortion> ? "rational_polynomial" : "plumb_bob", values);
  if (!distortion) {
    Refuse(node,
           "must be [k1, k2, p1, p2, k3, k4, k5, k6], [k1, k2, p1, p2, k3], [k1, k2, p1, p2], [] "
           "or none, not a list of " +
               std::to_string(values.size()));
  }
  return *distortion;
}

std::vector<Key> ModelKeys() {
  return {{"width_px", value::WholeNumber(1, kLargestSize_px), kRequired, "Width of the image."},
          {"height_px", value::WholeNumber(1, kLargestSize_px), kRequired, "Height of the image."},
          {"fx_px", value::Real(kPositive), kRequired, "Focal length along u."},
          {"fy_px", value::Real(kPositive), kRequired, "Focal length along v."},
          {"cx_px", value::Real(), kRequired,
           "Principal point, u. The centre of pixel (0, 0) is at u = v = 0."},
          {"cy_px", value::Real(), kRequired, "Principal point, v."},
          {"distortion", value::Either({value::Numbers({}, 0, kRational), value::Choice({"none"})}),
           kOptional,
           "Lens distortion `[k1, k2, p1, p2]`, `[k1, k2, p1, p2, k3]` or, of a rational model, "
           "`[k1, k2, p1, p2, k3, k4, k5, k6]` in OpenCV's order. `[]`, `none` or absent: none."}};
}

const KeyTable& DepthKeys() {
  static const KeyTable keys = [] {
    const RgbdCamera defaults;
    KeyTable table{.title = "depth camera",
                   .about =
                       "Pinhole model of the depth camera. Its optical frame: x right, y down, "
                       "z forward.",
                   .keys = ModelKeys()};
    table.keys.push_back(
        {"unit_m", value::Real(kUnitRule), kRequired, "Depth of one step of the 16-bit image."});
    table.keys.push_back({"invalid_value", value::WholeNumber(0, kLargestDepthValue),
                          Default(defaults.invalid_value), "Value of a pixel without depth."});
    table.keys.push_back({"baseline_m", value::Real(kBaselineRule), Default(defaults.baseline_m),
                          "Baseline of a stereo camera. 0: unknown, or not a stereo camera."});
    return table;
  }();
  return keys;
}

const KeyTable& ColorKeys() {
  static const KeyTable keys = [] {
    KeyTable table{.title = "colour camera",
                   .about = "Pinhole model of the colour camera.",
                   .keys = ModelKeys()};
    table.keys.push_back(
        {"registered_to_depth", value::Boolean(), Default(RgbdCamera{}.color_registered),
         "Pixels are those of the depth image. The model must be that of `depth`."});
    table.keys.push_back({"T_depth_color", value::Map(geometry::PoseKeys()), kOptional,
                          "Pose of the colour camera: p_depth = T p_color. Required unless "
                          "`registered_to_depth`."});
    return table;
  }();
  return keys;
}

CameraModel ReadModel(MapReader& reader) {
  CameraModel model;
  reader.Read("width_px", &model.width_px);
  reader.Read("height_px", &model.height_px);
  reader.Read("fx_px", &model.fx_px);
  reader.Read("fy_px", &model.fy_px);
  reader.Read("cx_px", &model.cx_px);
  reader.Read("cy_px", &model.cy_px);
  if (const ConfigNode* node = reader.Optional("distortion")) {
    model.distortion = ReadDistortion(*node);
  }
  return model;
}

void ReadDepthCamera(const ConfigNode& node, RgbdCamera* camera) {
  MapReader reader(node, DepthKeys());
  camera->depth = ReadModel(reader);
  reader.Read("unit_m", &camera->depth_unit_m);
  reader.Read("invalid_value", &camera->invalid_value);
  reader.Read("baseline_m", &camera->baseline_m);
  reader.Finish();
}

void ReadColorCamera(const ConfigNode& node, RgbdCamera* camera) {
  MapReader reader(node, ColorKeys());
  camera->color = ReadModel(reader);
  reader.Read("registered_to_depth", &camera->color_registered);
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
  const auto numbers = model.coefficients();
  const Eigen::Map<const Eigen::VectorXd> distortion(numbers.data(), ToIndex(numbers.size()));
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

const KeyTable& CameraFileKeys() {
  static const KeyTable keys{
      .title = "camera.yaml",
      .about = "A depth camera and the colour camera beside it.",
      .keys = {{"depth", value::Map(DepthKeys()), kRequired, "The depth camera."},
               {"color", value::Map(ColorKeys()), kOptional, "The colour camera. Absent: none."}}};
  return keys;
}

RgbdCamera ReadCamera(MapReader& reader) {
  RgbdCamera camera;
  ReadDepthCamera(reader.Require("depth"), &camera);
  if (const ConfigNode* node = reader.Optional("color")) ReadColorCamera(*node, &camera);
  return camera;
}

RgbdCamera ReadCamera(const ConfigNode& node) {
  MapReader reader(node, CameraFileKeys());
  RgbdCamera camera = ReadCamera(reader);
  reader.Finish();
  return camera;
}

RgbdCamera ReadCameraFile(const std::filesystem::path& file, const ConfigLoader& load) {
  const ConfigNode root = load(file);
  return IsRosCameraInfo(root) ? ReadRosCameraInfo(root) : ReadCamera(root);
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
