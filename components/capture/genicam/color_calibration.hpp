// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Geometry>
#include <array>
#include <optional>
#include <string>

#include "components/capture/genicam/features.hpp"
#include "libs/rgbd/camera_model.hpp"

namespace palpate::capture {

/// What some cameras report beyond GenICam's standard, which knows one camera model only: the
/// features Palpate... of our own virtual camera. Each part is unset where it is missing or absurd.
struct ColorCalibration {
  std::optional<rgbd::CameraModel> model;  ///< without its size
  std::optional<bool> registered;          ///< colour pixels are those of the range image
  std::optional<Eigen::Isometry3d> T_depth_color;
};

ColorCalibration ReadColorCalibration(Features& features);

/// Of the depth camera; zeros where it reports none.
rgbd::Distortion ReadDepthDistortion(Features& features);

}  // namespace palpate::capture
