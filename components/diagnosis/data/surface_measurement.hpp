// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>

#include "libs/fem/interpolation_weights.hpp"

namespace palpate::diagnosis {

/// One of a recording's depth images or clouds.
struct DepthFrame {
  int number = 0;  ///< in the recording, by time
  double t_s = 0.0;
};

/// Where a depth camera has the surface about one feature point of the body, along the normal
/// alone: a cloud does not show motion along the surface. Point and normal are held where
/// the cloud was matched with a shape of the body; the measured coordinate is linear about there.
struct SurfaceMeasurement {
  int count = 0;  ///< depth frames that show it; 0: none does, and all else says nothing
  fem::InterpolationWeights point;  ///< of the body, in the middle of its cloud points
  Eigen::Vector3d rest_m = Eigen::Vector3d::Zero();  ///< of that point, undeformed, robot frame
  /// Mean over its cloud points, outward, camera frame; shorter than 1 where the surface bends.
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  double measured_m = 0.0;  ///< normal' x of that point as the camera has it, mean over the sample
  double sigma_m = 0.0;     ///< of that mean, > 0
  /// How it changes with a wave of the camera's disparities, cosine and sine (StereoRipple), m per
  /// px.
  Eigen::Vector2d ripple_m_px = Eigen::Vector2d::Zero();
};

}  // namespace palpate::diagnosis
