// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "components/perception/observation.hpp"

namespace palpate::perception {

/// The point of the robot's surface nearest to a place.
struct NearestSurface {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d outward = Eigen::Vector3d::Zero();  ///< unit, off the surface towards outside
  double height_m = 0.0;                              ///< of the place over it; < 0: inside
};

struct SurfaceAroundTuning {
  /// Longest edge of the pieces. Larger: faster, less exact areas.
  double part_m = 2.5e-3;
};

/// The part of a predicted surface around a place, visible or not.
class SurfaceAround {
 public:
  /// All triangles that come within `radius_m` of `place_m`; there may be none.
  SurfaceAround(const PredictedSurface& surface, const Eigen::Vector3d& place_m, double radius_m,
                const SurfaceAroundTuning& tuning = {});

  bool empty() const { return corners_m_.cols() == 0; }

  /// Calls visit(middle, area in m^2) for each of the pieces of about part_m.
  template <typename Visit>
  void ForEachPart(Visit&& visit) const;

  /// Of this part, which must not be empty.
  NearestSurface Nearest(const Eigen::Vector3d& place_m) const;

 private:
  SurfaceAroundTuning tuning_;
  Eigen::Matrix3Xd corners_m_;  ///< [3 x 3t] three columns a triangle, anticlockwise from outside
};

template <typename Visit>
void SurfaceAround::ForEachPart(Visit&& visit) const {
  for (Eigen::Index t = 0; t < corners_m_.cols(); t += 3) {
    const Eigen::Vector3d a_m = corners_m_.col(t + 1) - corners_m_.col(t);
    const Eigen::Vector3d b_m = corners_m_.col(t + 2) - corners_m_.col(t);
    const double longest_m = std::max({a_m.norm(), b_m.norm(), (b_m - a_m).norm()});
    const int parts = std::max(1, static_cast<int>(std::ceil(longest_m / tuning_.part_m)));
    const double area_m2 = 0.5 * a_m.cross(b_m).norm() / (parts * parts);
    const auto at = [&](double i, double j) -> Eigen::Vector3d {
      return corners_m_.col(t) + (i * a_m + j * b_m) / parts;
    };
    for (int i = 0; i < parts; ++i) {
      for (int j = 0; i + j < parts; ++j) {
        visit(at(i + 1.0 / 3.0, j + 1.0 / 3.0), area_m2);
        if (i + j + 1 < parts) visit(at(i + 2.0 / 3.0, j + 2.0 / 3.0), area_m2);
      }
    }
  }
}

}  // namespace palpate::perception
