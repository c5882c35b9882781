// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/markers/curved_surface.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <cmath>

namespace palpate::perception {

namespace {

constexpr int kLeastSamples = 6;  // of six coefficients

}  // namespace

CurvedSurface::Coefficients CurvedSurface::Terms(const Eigen::Vector2d& ray) const {
  const Eigen::Vector2d at = (z_m_ / reach_m_) * (ray - center_);
  Coefficients terms;
  terms << 1.0, at.x(), at.y(), at.x() * at.x(), at.x() * at.y(), at.y() * at.y();
  return terms;
}

/// z of a slanted surface has a larger curvature than the surface.
CurvedSurface::Coefficients CurvedSurface::PriorInformation(const SurfacePrior& prior) const {
  const double slope_squared = coefficients_.segment<2>(1).squaredNorm() / (reach_m_ * reach_m_);
  const double bend = std::pow(1.0 + slope_squared, 1.5) / prior.bend_radius_m;
  Coefficients sigma;
  sigma << 1.0, tuning_.slope_sigma * reach_m_, tuning_.slope_sigma * reach_m_,
      0.5 * bend * reach_m_ * reach_m_, bend * reach_m_ * reach_m_,
      0.5 * bend * reach_m_ * reach_m_;
  return sigma.array().square().inverse();
}

bool CurvedSurface::Fit(const std::vector<DepthSample>& samples, const SurfacePrior& prior) {
  const double information = 1.0 / (prior.sigma_m * prior.sigma_m * prior.correlated);
  gate_m_ = tuning_.gate_sigmas * prior.sigma_m + tuning_.gate_bend * reach_m_;
  coefficients_.setZero();
  coefficients_[0] = z_m_;
  for (int round = 0; round < tuning_.rounds; ++round) {
    Eigen::Matrix<double, 6, 6> A = PriorInformation(prior).asDiagonal();
    Coefficients b = Coefficients::Zero();
    b[0] = A(0, 0) * z_m_;
    int used = 0;
    for (const DepthSample& sample : samples) {
      const Coefficients terms = Terms(sample.ray);
      const double off_m = sample.z_m - terms.dot(coefficients_);
      const bool fits = round == 0 ? sample.inner : std::abs(off_m) < gate_m_;
      if (!fits) continue;
      ++used;
      A += information * terms * terms.transpose();
      b += information * sample.z_m * terms;
    }
    if (used < kLeastSamples) return false;
    const Eigen::LDLT<Eigen::Matrix<double, 6, 6>> factor(A);
    coefficients_ = factor.solve(b);
    covariance_ = factor.solve(Eigen::Matrix<double, 6, 6>::Identity());
  }
  return coefficients_.allFinite() && coefficients_[0] > 0.0;
}

CurvedSurface::Point CurvedSurface::At(const Eigen::Vector2d& ray, const Coefficients& c) const {
  const Eigen::Vector2d at = (z_m_ / reach_m_) * (ray - center_);
  const double z_m = Terms(ray).dot(c);
  const double per_ray = z_m_ / reach_m_;
  const double z_x = per_ray * (c[1] + 2.0 * c[3] * at.x() + c[4] * at.y());
  const double z_y = per_ray * (c[2] + c[4] * at.x() + 2.0 * c[5] * at.y());
  const Eigen::Vector3d direction(ray.x(), ray.y(), 1.0);
  return {.position_m = z_m * direction,
          .along_x_m = z_x * direction + z_m * Eigen::Vector3d::UnitX(),
          .along_y_m = z_y * direction + z_m * Eigen::Vector3d::UnitY()};
}

CurvedSurface::Point CurvedSurface::Foot(const Eigen::Vector3d& point_m,
                                         const Coefficients& c) const {
  Point foot = At(point_m.head<2>() / point_m.z(), c);
  const Eigen::Vector3d normal = foot.AreaVector().normalized();
  Eigen::Vector3d place_m = point_m;
  for (int step = 0; step < tuning_.foot_rounds; ++step) {
    place_m += normal.dot(foot.position_m - place_m) * normal;
    foot = At(place_m.head<2>() / place_m.z(), c);
  }
  return foot;
}

double CurvedSurface::SlopeSigma() const {
  return std::sqrt(0.5 * (covariance_(1, 1) + covariance_(2, 2))) / reach_m_;
}

}  // namespace palpate::perception
