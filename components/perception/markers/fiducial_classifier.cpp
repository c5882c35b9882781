// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/markers/fiducial_classifier.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "libs/core/statistics.hpp"

namespace palpate::perception {

namespace {

constexpr double kPi = std::numbers::pi;

}  // namespace

FiducialClassifier::FiducialClassifier(const FiducialConfig& config,
                                       const Registration& registration,
                                       const FiducialClassifierTuning& tuning)
    : config_{config}, tuning_{tuning}, registration_{registration}, noise_{config.noise} {
  const rgbd::RgbdCamera& camera = registration.camera();
  step_ = {1.0 / camera.depth.fx_px, 1.0 / camera.depth.fy_px};
  const double scale = camera.color_registered || camera.color.fx_px <= 0.0
                           ? 1.0
                           : camera.depth.fx_px / camera.color.fx_px;
  blur_px2_ = tuning_.blur_px2 * scale * scale;
}

void FiducialClassifier::Classify(const ColorSpot& spot, const RegisteredFrame& frame,
                                  FiducialFrame* found) {
  Fiducial fiducial;
  const Reason reason = Measure(spot, frame, &fiducial);
  if (reason == nullptr) {
    found->fiducials.push_back(fiducial);
  } else {
    ++(found->rejected.*reason);
  }
}

FiducialClassifier::Reason FiducialClassifier::Measure(const ColorSpot& spot,
                                                       const RegisteredFrame& frame,
                                                       Fiducial* fiducial) {
  if (const Reason reason = CheckDepth(spot, frame)) return reason;
  const int reach_px =
      std::max(tuning_.window.rim_end_px,
               static_cast<int>(std::ceil(tuning_.surface_reach_radii * rough_radius_px_)));
  if (!window_.Lay(spot, reach_px, frame, registration_)) return &FiducialRejections::at_edge;
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  for (const SpotPixel& pixel : spot.pixels) middle += Eigen::Vector2d(pixel.u_px, pixel.v_px);
  middle /= static_cast<double>(spot.pixels.size());
  const Eigen::Vector3d ray = rgbd::Unproject(registration_.camera().depth, middle);
  if (!ray.allFinite()) return &FiducialRejections::at_edge;
  CurvedSurface surface(ray.head<2>(), z_m_, 2.0 * rough_radius_px_ * step_.mean() * z_m_,
                        tuning_.surface);
  if (!FitSurface(&surface)) return &FiducialRejections::no_depth;
  SpotColors colors;
  if (!Unmix(on_surface_, &window_, &colors, tuning_.window)) return &FiducialRejections::at_edge;
  if (colors.contrast < config_.min_contrast) return &FiducialRejections::wrong_color;
  fiducial->color = spot.color;
  fiducial->contrast = colors.contrast;
  fiducial->open_rim = OpenRim(colors);
  if (fiducial->open_rim > config_.max_open_rim) return &FiducialRejections::at_edge;
  double area_m2 = 0.0;
  const CurvedSurface::Point center = CenterOn(surface, surface.coefficients(), &area_m2);
  if (const Reason reason = CheckShape(surface, center, area_m2)) return reason;
  fiducial->position_m = center.position_m;
  fiducial->pixel_px = rgbd::Project(registration_.camera().depth, center.position_m);
  fiducial->radius_m = std::sqrt(area_m2 / kPi);
  fiducial->radius_px = fiducial->radius_m / (center.position_m.z() * step_.mean());
  SetCovariance(surface, colors, fiducial);
  return nullptr;
}

/// Coarse depth and size of the spot.
FiducialClassifier::Reason FiducialClassifier::CheckDepth(const ColorSpot& spot,
                                                          const RegisteredFrame& frame) {
  const auto pixels = static_cast<double>(spot.pixels.size());
  if (pixels < config_.min_pixels) return &FiducialRejections::too_small;
  depths_m_.clear();
  for (const SpotPixel& pixel : spot.pixels) {
    const auto z_m = static_cast<double>(*frame.z_m.Pixel(pixel.u_px, pixel.v_px));
    if (std::isfinite(z_m)) depths_m_.push_back(z_m);
  }
  if (static_cast<double>(depths_m_.size()) < tuning_.least_depth_share * pixels) {
    return &FiducialRejections::no_depth;
  }
  z_m_ = UpperMedian(depths_m_);
  if (z_m_ < config_.min_z_m || z_m_ > config_.max_z_m) return &FiducialRejections::no_depth;
  sigma_m_ = rgbd::DepthSigma_m(registration_.camera(), noise_, z_m_);
  const double largest_px = (1.0 + config_.size_tolerance) * config_.max_radius_m / z_m_;
  const double u_px = spot.last.u_px - spot.first.u_px + 1;
  const double v_px = spot.last.v_px - spot.first.v_px + 1;
  rough_radius_px_ = 0.5 * std::max(u_px, v_px);
  const bool larger =
      0.5 * std::max(u_px * step_.x(), v_px * step_.y()) > largest_px + step_.mean();
  return larger ? &FiducialRejections::too_large : nullptr;
}

/// Also marks the pixels of the window on that surface.
bool FiducialClassifier::FitSurface(CurvedSurface* surface) {
  samples_.clear();
  const double near_m = 5.0 * sigma_m_ + 3.0 * rough_radius_px_ * step_.mean() * z_m_;
  for (const SpotWindow::Pixel& pixel : window_.pixels) {
    if (!std::isfinite(pixel.z_m) || !pixel.ray.allFinite()) continue;
    const bool inner = pixel.distance_px == 0 && std::abs(pixel.z_m - z_m_) < near_m;
    samples_.push_back({pixel.ray, pixel.z_m, inner});
  }
  const auto count = static_cast<double>(samples_.size());
  const SurfacePrior prior{.sigma_m = sigma_m_,
                           .correlated = count / rgbd::IndependentPixels(noise_, count),
                           .bend_radius_m = config_.bend_radius_m};
  if (!surface->Fit(samples_, prior)) return false;
  on_surface_.clear();
  for (const SpotWindow::Pixel& pixel : window_.pixels) {
    const bool on = std::isfinite(pixel.z_m) && pixel.ray.allFinite() &&
                    std::abs(pixel.z_m - surface->Z_m(pixel.ray)) < surface->gate_m();
    on_surface_.push_back(on ? 1 : 0);
  }
  return true;
}

/// Share of the rim off the surface, without depth, or of another colour.
double FiducialClassifier::OpenRim(const SpotColors& colors) const {
  const Eigen::Vector3d around = colors.around.normalized();
  double rim = 0.0, open = 0.0;
  for (std::size_t i = 0; i < window_.pixels.size(); ++i) {
    const SpotWindow::Pixel& pixel = window_.pixels[i];
    if (pixel.distance_px <= tuning_.window.spot_reach_px ||
        pixel.distance_px > tuning_.window.rim_end_px)
      continue;
    const bool other = pixel.color_known &&
                       (pixel.rgb.stableNormalized() - around).norm() > config_.color_tolerance;
    rim += 1.0;
    open += on_surface_[i] == 0 || other ? 1.0 : 0.0;
  }
  return open / std::max(1.0, rim);
}

/// The disc's centre: the mean of its area, projected onto the curved surface.
CurvedSurface::Point FiducialClassifier::CenterOn(const CurvedSurface& surface,
                                                  const CurvedSurface::Coefficients& coefficients,
                                                  double* area_m2) const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double area = 0.0;
  for (const SpotWindow::Pixel& pixel : window_.pixels) {
    if (!InSpot(pixel) || !pixel.ray.allFinite()) continue;
    const CurvedSurface::Point point = surface.At(pixel.ray, coefficients);
    const double share_m2 = pixel.share * point.AreaVector().norm() * step_.prod();
    sum += share_m2 * point.position_m;
    area += share_m2;
  }
  if (area_m2 != nullptr) *area_m2 = area;
  return surface.Foot(sum / area, coefficients);
}

/// Second moments of the disc in the plane that is tangent to the surface, without the image's
/// blur, m^2.
Eigen::Matrix2d FiducialClassifier::Moments(const CurvedSurface& surface,
                                            const CurvedSurface::Point& center,
                                            double area_m2) const {
  Eigen::Matrix<double, 3, 2> axes;
  axes.col(0) = center.along_x_m.normalized();
  axes.col(1) = center.AreaVector().cross(center.along_x_m).normalized();
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
  for (const SpotWindow::Pixel& pixel : window_.pixels) {
    if (!InSpot(pixel) || !pixel.ray.allFinite()) continue;
    const CurvedSurface::Point point = surface.At(pixel.ray);
    const double weight = pixel.share * point.AreaVector().norm() * step_.prod() / area_m2;
    const Eigen::Vector2d off = axes.transpose() * (point.position_m - center.position_m);
    mean += weight * off;
    squares += weight * off * off.transpose();
  }
  Eigen::Matrix<double, 3, 2> per_px;
  per_px << center.along_x_m * step_.x(), center.along_y_m * step_.y();
  const Eigen::Matrix2d blur = axes.transpose() * per_px;
  return squares - mean * mean.transpose() - blur_px2_ * blur * blur.transpose();
}

/// On the surface a disc is round from any viewpoint.
FiducialClassifier::Reason FiducialClassifier::CheckShape(const CurvedSurface& surface,
                                                          const CurvedSurface::Point& center,
                                                          double area_m2) const {
  if (!(area_m2 > 0.0)) return &FiducialRejections::too_small;
  const Eigen::Vector3d normal = center.AreaVector().normalized();
  const double cosine = std::abs(normal.dot(center.position_m.normalized()));
  if (cosine < tuning_.least_cosine) return &FiducialRejections::at_edge;
  const double radius_m = std::sqrt(area_m2 / kPi);
  const double slack = config_.size_tolerance;
  if (radius_m < (1.0 - slack) * config_.min_radius_m) return &FiducialRejections::too_small;
  if (radius_m > (1.0 + slack) * config_.max_radius_m) return &FiducialRejections::too_large;
  const Eigen::Vector2d moments =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(Moments(surface, center, area_m2))
          .eigenvalues();
  if (moments[0] <= 0.0) return &FiducialRejections::not_round;
  // Uncertainty of the slant: relative error of cos a.
  const double tangent = std::sqrt(1.0 / (cosine * cosine) - 1.0);
  const double slant = 2.0 * surface.SlopeSigma() * tangent * cosine * cosine;
  const double roundness = std::sqrt(moments[0] / moments[1]);
  const double fill = area_m2 / (4.0 * kPi * std::sqrt(moments[0] * moments[1]));
  const bool round = roundness > 1.0 - config_.shape_tolerance - slant &&
                     std::abs(fill - 1.0) < config_.shape_tolerance;
  return round ? nullptr : &FiducialRejections::not_round;
}

/// Of the centroid in the image, in each direction.
double FiducialClassifier::PlaceSigma_px(const SpotColors& colors, const Fiducial& fiducial) const {
  double arms = 0.0, shares = 0.0;
  for (const SpotWindow::Pixel& pixel : window_.pixels) {
    if (!InSpot(pixel)) continue;
    arms += 0.5 * (pixel.at_px - fiducial.pixel_px).squaredNorm();
    shares += pixel.share;
  }
  const double noise_px = colors.share_sigma * std::sqrt(arms) / std::max(1.0, shares);
  const double open_px = tuning_.open_shift * fiducial.open_rim * fiducial.radius_px;
  double parallax_px = 0.0;
  const rgbd::RgbdCamera& camera = registration_.camera();
  if (!camera.color_registered) {
    const double z_m = fiducial.position_m.z();
    const double off_m = std::hypot(config_.depth_bias * z_m, 0.5 * sigma_m_);
    parallax_px = camera.T_depth_color.translation().norm() * off_m / (z_m * z_m * step_.mean());
  }
  return std::sqrt(config_.rim_sigma_px * config_.rim_sigma_px + noise_px * noise_px +
                   open_px * open_px + parallax_px * parallax_px);
}

void FiducialClassifier::SetCovariance(const CurvedSurface& surface, const SpotColors& colors,
                                       Fiducial* fiducial) const {
  Eigen::Matrix<double, 3, 6> J;  // derivative of the centre by the surface's coefficients
  for (Eigen::Index k = 0; k < 6; ++k) {
    const double step = std::sqrt(surface.covariance()(k, k));
    const CurvedSurface::Coefficients change = step * CurvedSurface::Coefficients::Unit(k);
    J.col(k) = (CenterOn(surface, surface.coefficients() + change, nullptr).position_m -
                CenterOn(surface, surface.coefficients() - change, nullptr).position_m) /
               (2.0 * step);
  }
  const Eigen::Vector3d ray = fiducial->position_m / fiducial->position_m.z();
  const CurvedSurface::Point center = surface.At(ray.head<2>());
  Eigen::Matrix<double, 3, 2> per_px;
  per_px << center.along_x_m * step_.x(), center.along_y_m * step_.y();
  const double place_px = PlaceSigma_px(colors, *fiducial);
  const double bias_m = config_.depth_bias * fiducial->position_m.z();
  fiducial->covariance_m2 = J * surface.covariance() * J.transpose() +
                            place_px * place_px * per_px * per_px.transpose() +
                            bias_m * bias_m * ray * ray.transpose();
}

}  // namespace palpate::perception
