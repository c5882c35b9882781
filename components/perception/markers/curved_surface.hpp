// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

namespace palpate::perception {

/// A measured point z_m * (ray.x, ray.y, 1), camera frame.
struct DepthSample {
  Eigen::Vector2d ray = Eigen::Vector2d::Zero();
  double z_m = 0.0;
  bool inner = false;  ///< within the marker
};

/// Prior and noise of the samples.
struct SurfacePrior {
  double sigma_m = 1e-3;        ///< of each z
  double correlated = 1.0;      ///< neighbours with the information of one, >= 1
  double bend_radius_m = 0.01;  ///< one sigma of the curvature is its inverse
};

struct CurvedSurfaceTuning {
  int rounds = 5;  ///< of fit and selection; more: slower, a more exact optimum
  /// Distance of a sample that belongs to another surface, in sigmas and, as a surface is no
  /// parabola, as a share of the patch's size. Larger: edges and other objects bend the fit.
  double gate_sigmas = 4.0;
  double gate_bend = 0.1;
  /// Prior sigma of dz/dx: surfaces are rarely seen at a more grazing angle. Larger: noise tilts
  /// patches of few samples.
  double slope_sigma = 2.0;
  int foot_rounds = 4;  ///< of Foot; more: slower, a more exact projection
};

/// A small patch of a surface: z is a polynomial of second degree in x and y.
class CurvedSurface {
 public:
  using Coefficients = Eigen::Matrix<double, 6, 1>;

  /// About the ray `center` at about `z_m`; `reach_m` is about the size of the patch.
  CurvedSurface(const Eigen::Vector2d& center, double z_m, double reach_m,
                const CurvedSurfaceTuning& tuning = {})
      : tuning_{tuning}, center_{center}, z_m_{z_m}, reach_m_{reach_m} {}

  /// Fits z to the inner samples, then to all that lie no farther than gate_m() from it. False
  /// where there are fewer than six inner ones.
  bool Fit(const std::vector<DepthSample>& samples, const SurfacePrior& prior);

  double gate_m() const { return gate_m_; }
  const Coefficients& coefficients() const { return coefficients_; }
  const Eigen::Matrix<double, 6, 6>& covariance() const { return covariance_; }

  struct Point {
    Eigen::Vector3d position_m;  ///< camera frame
    Eigen::Vector3d along_x_m;   ///< derivative of the position by ray.x
    Eigen::Vector3d along_y_m;   ///< likewise
    Eigen::Vector3d AreaVector() const { return along_x_m.cross(along_y_m); }
  };
  Point At(const Eigen::Vector2d& ray, const Coefficients& coefficients) const;
  Point At(const Eigen::Vector2d& ray) const { return At(ray, coefficients_); }
  double Z_m(const Eigen::Vector2d& ray) const { return Terms(ray).dot(coefficients_); }
  /// Projection of `point_m` onto the patch along its normal.
  Point Foot(const Eigen::Vector3d& point_m, const Coefficients& coefficients) const;
  /// Sigma of its slope dz/dx, one number for both directions.
  double SlopeSigma() const;

 private:
  Coefficients Terms(const Eigen::Vector2d& ray) const;
  Coefficients PriorInformation(const SurfacePrior& prior) const;

  CurvedSurfaceTuning tuning_;
  Eigen::Vector2d center_;
  double z_m_;
  double reach_m_;
  double gate_m_ = 0.0;
  Coefficients coefficients_ = Coefficients::Zero();
  Eigen::Matrix<double, 6, 6> covariance_ = Eigen::Matrix<double, 6, 6>::Zero();
};

}  // namespace palpate::perception
