// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <string>

#include "libs/core/config_node.hpp"
#include "libs/core/config_reader.hpp"
#include "libs/rgbd/camera_model.hpp"

namespace palpate::rgbd {

/// A depth camera and the colour camera beside it: camera.yaml of a recording
/// (docs/experiment.md).
struct RgbdCamera {
  CameraModel depth;
  double depth_unit_m = 1e-4;     ///< metres in one step of the depth image, > 0
  int invalid_value = 0;          ///< of a pixel without depth, [0, 65535]
  double baseline_m = 0.0;        ///< of a stereo camera, >= 0; 0: unknown or no stereo camera
  CameraModel color;              ///< width_px = 0: there is no colour camera
  bool color_registered = false;  ///< colour pixels are those of the depth image
  /// p_depth = T_depth_color * p_color.
  Eigen::Isometry3d T_depth_color = Eigen::Isometry3d::Identity();

  bool operator==(const RgbdCamera& other) const;
};

/// The keys of camera.yaml.
const KeyTable& CameraFileKeys();

/// Reads camera.yaml strictly; throws InputError with file:line:column. These may be missing:
/// `color`, `distortion` (none; else k1, k2, p1, p2 and, where they are not 0, k3, k4, k5, k6),
/// `invalid_value` (0), `baseline_m` (0), `registered_to_depth` (false); `T_depth_color` of a
/// registered image only, whose intrinsics must be those of `depth`.
RgbdCamera ReadCameraFile(const std::filesystem::path& file, const ConfigLoader& load);
/// The same from a tree that stands inside another file.
RgbdCamera ReadCamera(const ConfigNode& node);
/// The same from the keys `depth` and `color` of a map that has other keys as well; its table, if
/// it has one, must hold these two.
RgbdCamera ReadCamera(MapReader& reader);
/// The text that ReadCameraFile reads back exactly (a rotation to the last bit or two).
std::string FormatCameraFile(const RgbdCamera& camera);

}  // namespace palpate::rgbd
