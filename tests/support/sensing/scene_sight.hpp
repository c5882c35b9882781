// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "libs/geometry/triangle_surface.hpp"
#include "libs/rgbd/surface_view.hpp"
#include "tests/support/sensing/sensing_scene.hpp"

namespace palpate::test_support {

/// What a camera could see of the true body if there were no tools.
class SceneSight {
 public:
  explicit SceneSight(const SensingScene& scene, std::size_t camera = 0);

  /// At the scene's present state.
  void Look();
  /// Robot frame, at the last Look.
  const geometry::TriangleSurface& surface() const { return surface_; }

  /// Seen share of the area within `radius_m` of `position_m` (robot frame); 0 where there is none.
  double SeenShare(const Eigen::Vector3d& position_m, double radius_m) const;

 private:
  bool IsSeen(const Eigen::Vector3d& centroid_m, const Eigen::Vector3d& normal) const;

  const SensingScene& scene_;
  std::size_t camera_;
  geometry::TriangleSurface surface_;
  rgbd::SurfaceView view_;
};

Eigen::Vector3d Centroid_m(const geometry::TriangleSurface& surface, int triangle);

}  // namespace palpate::test_support
