// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <optional>

namespace palpate::perception {

/// A ball whose surface some points lie on.
struct Ball {
  Eigen::Vector3d center_m = Eigen::Vector3d::Zero();
  double radius_m = 0.0;
  double residual_m = 0.0;  ///< RMS distance of the points from its surface
  double covered_m = 0.0;   ///< standard deviation of the points along their second longest axis
  Eigen::Matrix4d covariance_m2 = Eigen::Matrix4d::Zero();  ///< of centre and radius

  Eigen::Matrix3d CenterCovariance_m2() const { return covariance_m2.topLeftCorner<3, 3>(); }
};

struct BallFitTuning {
  Eigen::Index fewest_points = 12;  ///< fewer: balls through noise
  int rounds = 5;                   ///< Gauss-Newton; more: slower, a more exact optimum
  double largest_radius_m = 0.1;    ///< larger: flat objects count as balls
};

/// Least squares of the distances from the ball's surface (Gauss-Newton from the algebraic fit).
/// Empty where the points [3 x n] are too few, flat, or concave: the camera, in the origin, is
/// outside of a ball. `sigma_m`: of a point.
std::optional<Ball> FitBall(const Eigen::Matrix3Xd& points_m, double sigma_m,
                            const BallFitTuning& tuning = {});

}  // namespace palpate::perception
