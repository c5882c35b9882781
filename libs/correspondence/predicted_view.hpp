// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "libs/rgbd/surface_view.hpp"

namespace palpate::correspondence {

/// What can be seen of a surface from the camera's centre. Which camera it is does not matter for
/// that: the view is a pinhole of a fixed size, turned and drawn out so that the surface fills it.
/// A pixel is then about a millimetre of a robot, less than a facet, and drawing costs little.
class PredictedView {
 public:
  static constexpr int kSide_px = 256;

  PredictedView();

  /// `vertices_m` [3 x v] camera frame; `triangles` [3 x t] of a closed surface, counter-clockwise
  /// seen from outside.
  void Look(const Eigen::Matrix3Xd& vertices_m, const Eigen::Matrix3Xi& triangles);

  /// The triangle seen in the direction of `point_m` (camera frame), or, where nothing is, nearest
  /// to it within `search_m` across the line of sight; SurfaceView::kNothing else.
  int TriangleAt(const Eigen::Vector3d& point_m, double search_m) const;

  /// Whether the surface hides `point_m` by lying more than `tolerance_m` before it.
  bool Hides(const Eigen::Vector3d& point_m, double tolerance_m) const;

 private:
  bool Aim(const Eigen::Matrix3Xd& vertices_m);
  /// Of a closed surface those that are turned away lie behind others.
  void TakeFacing(const Eigen::Matrix3Xd& vertices_m, const Eigen::Matrix3Xi& triangles);
  bool Inside(int u_px, int v_px) const;
  /// Pixel of a point; false where it is outside the view.
  bool PixelOf(const Eigen::Vector3d& point_m, Eigen::Vector2i* pixel, double* z_m) const;

  rgbd::SurfaceView view_;
  Eigen::Matrix3d aim_ = Eigen::Matrix3d::Zero();  ///< camera frame to (z u, z v, z), v, u about 0
  double scale_px_ = 0.0;                          ///< focal length
  Eigen::Matrix3Xd aimed_m_;
  Eigen::Matrix3Xi facing_;   ///< [3 x t] the first `numbers_.size()` columns count
  std::vector<int> numbers_;  ///< of the triangles in facing_
};

}  // namespace palpate::correspondence
