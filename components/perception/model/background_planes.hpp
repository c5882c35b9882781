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

struct BackgroundPlanesTuning {
  int most_planes = 3;  ///< per frame; more: slower, smaller planes are found
  int trials = 120;     ///< of RANSAC; more: slower, a plane of few points is missed less often
  /// Until a plane that is unknown or lost is searched again. Fewer: slower, earlier background.
  int frames_between_searches = 15;
  /// Of the points that no other plane holds. Smaller: objects count as background.
  double least_share = 0.12;
  std::size_t least_points = 50;  ///< fewer: planes through noise
  float least_extent_m = 0.25f;   ///< of a plane where the robot's size is unknown
  /// Size of a plane over that of the robot, in both directions. Smaller: plates that touch the
  /// robot count as background.
  float least_robot_sizes = 1.0f;
  /// Share of the robot's points that may lie so far behind a plane: its feet stand on it. Larger:
  /// planes through the robot count as background.
  double most_behind = 0.02;
  float behind_m = 0.015f;
  /// A plane on which the robot stands (a base, a pedestal) may be smaller by this factor. Tools
  /// are smaller still. Smaller: tools count as a base.
  float base_share = 0.4f;
  /// The robot stands on a plane where this share of its points is this close.
  float foot_m = 0.010f;
  double least_feet = 0.01;
};

/// The background: planes behind the robot that are larger than it, and smaller ones on which it
/// stands (or a plate as large that pushes the robot from behind). They are tracked from frame to
/// frame, refitted to each.
class BackgroundPlanes {
 public:
  struct Tolerance {
    NoiseLaw noise;
    float bias = 0.006f;  ///< largest smooth depth error, as a share of z
    float At(float z_m) const { return 3.0f * noise.At(z_m) + bias * z_m; }
  };

  explicit BackgroundPlanes(const BackgroundPlanesTuning& tuning = {}) : tuning_(tuning) {}

  /// `points_m`: sparse, of the whole frame, without those where the robot is predicted.
  /// `robot_m`: points on the robot; empty: its shape is unknown.
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

  BackgroundPlanesTuning tuning_;
  std::vector<Plane> planes_;
  int until_search_ = 0;  ///< frames
};

}  // namespace palpate::perception
