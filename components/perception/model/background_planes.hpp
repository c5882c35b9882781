// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "components/perception/noise_law.hpp"

namespace palpate::perception {

/// n . p = offset with the unit normal n towards the camera.
struct Plane {
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();
  float offset_m = 0.0f;

  /// Positive on the camera's side.
  float Height_m(const Eigen::Vector3f& point_m) const { return normal.dot(point_m) - offset_m; }
};

/// What the robot stands on and what is behind it: planes that are larger than the robot and have
/// it on the camera's side, and smaller ones, nearly half as large, that it touches besides: a base
/// (or a plate as large that pushes the robot from behind). They are kept from frame to frame,
/// fitted again to each.
class BackgroundPlanes {
 public:
  struct Tolerance {
    NoiseLaw noise;
    float bias = 0.006f;  ///< share of z by which the depth may be bent
    float At(float z_m) const { return 3.0f * noise.At(z_m) + bias * z_m; }
  };

  /// `points_m`: sparse, of the whole frame, without those where the robot is predicted.
  /// `robot_m`: points on the robot; none: not known where it is.
  void Update(const std::vector<Eigen::Vector3f>& points_m,
              const std::vector<Eigen::Vector3f>& robot_m, const Tolerance& tolerance);

  const std::vector<Plane>& planes() const { return planes_; }
  /// On one of them, or behind it.
  bool Holds(const Eigen::Vector3f& point_m, const Tolerance& tolerance) const {
    for (const Plane& plane : planes_) {
      if (plane.Height_m(point_m) < tolerance.At(point_m.z())) return true;
    }
    return false;
  }

 private:
  bool Refit(const std::vector<Eigen::Vector3f>& points_m, const Tolerance& tolerance,
             Plane* plane) const;
  bool Find(const std::vector<Eigen::Vector3f>& points_m, const Tolerance& tolerance,
            Plane* plane) const;

  std::vector<Plane> planes_;
  int until_search_ = 0;  ///< frames
};

}  // namespace palpate::perception
