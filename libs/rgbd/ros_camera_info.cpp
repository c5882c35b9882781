// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/rgbd/ros_camera_info.hpp"

#include <optional>
#include <string>
#include <vector>

#include "libs/core/config_reader.hpp"
#include "libs/core/text.hpp"
#include "libs/rgbd/ros_formats.hpp"

namespace palpate::rgbd {

namespace {

constexpr int kWidest_px = 16384;
constexpr NumberRule kStepRule{.min = 0.0, .max = 0.1, .min_open = true};

/// The first of `keys` that the map has; nullptr: none.
const ConfigNode* FindAny(const ConfigNode& root, const std::vector<std::string>& keys) {
  for (const std::string& key : keys) {
    if (const ConfigNode* node = root.Find(key)) return node;
  }
  return nullptr;
}

const ConfigNode& RequireAny(const ConfigNode& root, const std::vector<std::string>& keys) {
  if (const ConfigNode* node = FindAny(root, keys)) return *node;
  Refuse(root, "is ROS' camera_info without '" + keys.front() + "'");
}

/// A list, or the `data` of {rows, cols, data}.
std::vector<double> ReadMatrix(const ConfigNode& node) {
  if (node.kind != ConfigNode::Kind::kMap) return ReadNumbers(node);
  const ConfigNode* data = node.Find("data");
  if (data == nullptr) Refuse(node, "has no 'data'");
  return ReadNumbers(*data);
}

Distortion ReadLens(const ConfigNode& root) {
  const ConfigNode* name = FindAny(root, {"distortion_model"});
  const ConfigNode* node = FindAny(root, {"distortion_coefficients", "d", "D"});
  if (node == nullptr) return {};
  const std::string model = name == nullptr ? "plumb_bob" : name->text;
  const auto distortion = DistortionOf(model, ReadMatrix(*node));
  if (distortion) return *distortion;
  Refuse(*node, "the lens '" + Excerpt(model) +
                    "' is not modelled (plumb_bob of 4 or 5 numbers, rational_polynomial of 8): "
                    "calibrate the camera with plumb_bob, or rectify its images");
}

/// Images that are binned or cut have other intrinsics than the matrix, which is of the whole
/// image.
void RefusePartOfImage(const ConfigNode& root) {
  for (const char* key : {"binning_x", "binning_y"}) {
    const ConfigNode* binning = root.Find(key);
    if (binning == nullptr || ReadInteger(*binning, 0, kWidest_px) <= 1) continue;
    Refuse(*binning,
           "the images are binned: record them without, or write the intrinsics of the "
           "binned images with " +
               std::string(key) + ": 1");
  }
  const ConfigNode* roi = root.Find("roi");
  if (roi == nullptr) return;
  for (const char* key : {"x_offset", "y_offset"}) {
    const ConfigNode* offset = roi->Find(key);
    if (offset == nullptr || ReadInteger(*offset, 0, kWidest_px) == 0) continue;
    Refuse(*offset,
           "the images are a part of the sensor's: record them whole, or write the "
           "intrinsics of the part without 'roi'");
  }
}

}  // namespace

bool IsRosCameraInfo(const ConfigNode& root) {
  if (root.kind != ConfigNode::Kind::kMap || root.Find("depth") != nullptr) return false;
  return FindAny(root, {"camera_matrix"}) != nullptr ||
         (FindAny(root, {"k", "K"}) != nullptr && FindAny(root, {"width"}) != nullptr);
}

RgbdCamera ReadRosCameraInfo(const ConfigNode& root) {
  constexpr std::size_t kEntries = 9;
  RefusePartOfImage(root);
  RgbdCamera camera;
  camera.depth.width_px = ReadInteger(RequireAny(root, {"image_width", "width"}), 1, kWidest_px);
  camera.depth.height_px = ReadInteger(RequireAny(root, {"image_height", "height"}), 1, kWidest_px);
  const ConfigNode& matrix = RequireAny(root, {"camera_matrix", "k", "K"});
  const std::vector<double> K = ReadMatrix(matrix);
  if (K.size() != kEntries || !(K[0] > 0.0) || !(K[4] > 0.0)) {
    Refuse(matrix, "must be nine numbers [fx, 0, cx, 0, fy, cy, 0, 0, 1], fx and fy above 0");
  }
  camera.depth.fx_px = K[0];
  camera.depth.cx_px = K[2];
  camera.depth.fy_px = K[4];
  camera.depth.cy_px = K[5];
  camera.depth.distortion = ReadLens(root);
  const ConfigNode* unit = root.Find("unit_m");
  if (unit == nullptr) {
    Refuse(root,
           "is ROS' camera_info, which does not tell the depth of one step of the 16-bit images: "
           "add 'unit_m: 0.001' to it for millimetres");
  }
  camera.depth_unit_m = ReadNumber(*unit, kStepRule);
  if (const ConfigNode* node = root.Find("invalid_value")) {
    camera.invalid_value = ReadInteger(*node, 0, 65535);
  }
  if (const ConfigNode* node = root.Find("baseline_m")) {
    camera.baseline_m = ReadNumber(*node, {.min = 0.0, .max = 2.0});
  }
  return camera;
}

}  // namespace palpate::rgbd
