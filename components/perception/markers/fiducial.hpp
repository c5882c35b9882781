// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "libs/core/status.hpp"

namespace palpate::perception {

/// A coloured disc on a surface.
struct Fiducial {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  ///< centre, on the surface; depth camera
  /// Image position errs along the surface, depth along the ray.
  Eigen::Matrix3d covariance_m2 = Eigen::Matrix3d::Zero();
  Eigen::Vector2d pixel_px = Eigen::Vector2d::Zero();  ///< its projection in the depth image
  double radius_px = 0.0;                              ///< of a frontal disc at its depth
  double radius_m = 0.0;                               ///< on the surface
  double contrast = 0.0;  ///< distance of its colour direction from the surroundings', [0, 1.4]
  double open_rim = 0.0;  ///< share of the rim that does not border on its own surface
  int color = 0;          ///< which of FiducialConfig::color_rgb
  /// The robot's marker: where FiducialConfig::names has its colour and only one fiducial of
  /// the frame has; else empty.
  std::string name;
};

/// Spots of a marker's colour that are no markers, by the first reason found.
struct FiducialRejections {
  int too_small = 0;
  int too_large = 0;
  int not_round = 0;    ///< also: partly covered
  int no_depth = 0;     ///< too few pixels with depth, or out of range
  int at_edge = 0;      ///< of the image or of the surface, edge-on, or occluded
  int wrong_color = 0;  ///< similar to its surroundings

  int Count() const { return too_small + too_large + not_round + no_depth + at_edge + wrong_color; }
};

/// Fiducials of one frame.
struct FiducialFrame {
  Status status;                    ///< kInvalidInput with the reason: no fiducials
  std::vector<Fiducial> fiducials;  ///< from the top of the image to its bottom
  FiducialRejections rejected;
};

}  // namespace palpate::perception
