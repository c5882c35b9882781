// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "libs/plot/rect.hpp"

namespace palpate::view {

using plot::Rect;

/// Viewpoint: the direction from the scene to the viewer.
struct ViewDirection {
  double azimuth_deg = -60.0;   ///< about z, from x towards y
  double elevation_deg = 22.0;  ///< above the x-y plane, in (-90, 90)
  /// Distance of the eye in radii of the scene; 0: orthographic (lengths can be measured).
  double eye_distance_radii = 0.0;
};

/// A ball of the scene that must be inside the image.
struct Extent {
  Eigen::Vector3d center_m;
  double radius_m = 0.0;
};

/// Maps points of the scene (m, z up) to the image.
class Camera {
 public:
  /// The camera that shows all `extents` as large as `area` allows, centred in it.
  static Camera Fit(const ViewDirection& view, const std::vector<Extent>& extents,
                    const Rect& area);

  /// x to the right and y down in px; the third entry is the nearness: larger is closer to the
  /// viewer, and it is linear over a plane in the image in both projections.
  Eigen::Vector3d Project(const Eigen::Vector3d& point_m) const;

  /// px for one metre at the centre of the scene (everywhere, if orthographic).
  double px_per_m() const { return px_per_m_; }
  bool orthographic() const { return eye_distance_m_ <= 0.0; }
  const Eigen::Vector3d& right() const { return right_; }
  const Eigen::Vector3d& up() const { return up_; }
  /// Unit vector from the point to the viewer.
  Eigen::Vector3d TowardViewer(const Eigen::Vector3d& point_m) const;

 private:
  Eigen::Vector3d right_ = Eigen::Vector3d::UnitX();
  Eigen::Vector3d up_ = Eigen::Vector3d::UnitZ();
  Eigen::Vector3d toward_ = -Eigen::Vector3d::UnitY();
  Eigen::Vector3d target_m_ = Eigen::Vector3d::Zero();
  Eigen::Vector2d origin_px_ = Eigen::Vector2d::Zero();
  double px_per_m_ = 1.0;
  double eye_distance_m_ = 0.0;
};

}  // namespace palpate::view
