// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "libs/rgbd/rgbd_camera.hpp"
#include "libs/scenario/effect.hpp"

namespace palpate::virtual_camera {

/// What is wrong with the camera, put together from the effects of the catalogue that belong to it
/// (docs/theory/model_selection.md). Effects of one kind add up.
struct CameraFaults {
  struct Move {
    int from_recording = 0;
    /// p_before = T_before_after * p_after, of the depth camera's frame.
    Eigen::Isometry3d T_before_after = Eigen::Isometry3d::Identity();
  };
  struct Drift {
    double amplitude_m = 0.0;
    double tau_s = 1.0;
  };

  std::vector<Move> moves;
  double depth_scale = 0.0;       ///< s: depth is (1 + s) times the true one, along the ray
  double incidence_bias_m = 0.0;  ///< b of b (1/cos a - 1), along the ray, cos a >= 0.25
  double flying_pixel_ratio = 0.0;
  double focal = 0.0;  ///< the true focal length is (1 + focal) times that of the data sheet
  double cx_px = 0.0;  ///< added to the data sheet's
  double cy_px = 0.0;
  double k1 = 0.0;
  std::vector<Drift> drifts;

  /// Where the depth camera really is in a recording.
  Eigen::Isometry3d MovedPose(const Eigen::Isometry3d& T_robot_camera, int recording) const;
  /// Added to z, `t_s` after the camera was switched on: amplitude (1 - exp(-t / tau)).
  double DriftAt(double t_s) const;
  /// The depth camera as it is. What the depth image says stays true along the camera's axis: only
  /// the pixels' rays differ.
  rgbd::CameraModel TrueDepthCamera(const rgbd::CameraModel& data_sheet) const;
};

/// Ignores effects of body, base and actuators.
CameraFaults FaultsFrom(const std::vector<scenario::ActiveEffect>& effects, std::uint64_t seed);

}  // namespace palpate::virtual_camera
