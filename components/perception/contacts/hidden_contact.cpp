// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/contacts/hidden_contact.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <vector>

namespace palpate::perception {

namespace {

Eigen::Matrix3Xd Near(const rgbd::SensedCloud& cloud, const Eigen::Vector3d& place_m,
                      double radius_m) {
  const Eigen::Vector3f at_m = place_m.cast<float>();
  const auto limit_m2 = static_cast<float>(radius_m * radius_m);
  std::vector<Eigen::Index> near;
  for (Eigen::Index i = 0; i < cloud.Count(); ++i) {
    if ((cloud.points_m.col(i) - at_m).squaredNorm() <= limit_m2) near.push_back(i);
  }
  return cloud.points_m(Eigen::all, near).cast<double>();
}

bool IsRound(const Ball& ball, double noise_m, const HiddenContactTuning& tuning) {
  const double largest_m = tuning.largest_sigma * ball.radius_m;
  return ball.residual_m <= tuning.noise_sigmas * noise_m + tuning.out_of_round * ball.radius_m &&
         ball.covered_m >= tuning.least_covered * ball.radius_m &&
         ball.CenterCovariance_m2().trace() <= largest_m * largest_m;
}

struct Plane {
  Eigen::Vector3d point_m;
  Eigen::Vector3d normal;  ///< towards the ball
};

Plane FitPlane(const Eigen::Matrix3Xd& points_m, const Ball& ball, double fade_m) {
  const Eigen::RowVectorXd distance_m =
      (points_m.colwise() - ball.center_m).colwise().norm().array() - ball.radius_m;
  Eigen::RowVectorXd weight =
      (-distance_m.array().square() / (2.0 * fade_m * fade_m)).max(-100.0).exp();
  weight /= weight.sum();
  Plane plane;
  plane.point_m = points_m * weight.transpose();
  const Eigen::Matrix3Xd off_m = points_m.colwise() - plane.point_m;
  const Eigen::Matrix3d scatter_m2 = off_m * weight.asDiagonal() * off_m.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(scatter_m2);
  plane.normal = axes.eigenvectors().col(0);
  if (plane.normal.dot(ball.center_m - plane.point_m) < 0.0) plane.normal = -plane.normal;
  return plane;
}

/// One sigma of the gap between ball and surface.
double GapSigma_m(const Ball& ball, const NearestSurface& nearest, double surface_sigma_m) {
  Eigen::Vector4d gradient;
  gradient << nearest.outward, -1.0;
  return std::sqrt(gradient.dot(ball.covariance_m2 * gradient) + surface_sigma_m * surface_sigma_m);
}

/// The ball given that it touches the surface. A small cap determines neither radius nor centre;
/// the surface does. Gauss-Newton from the fitted ball (iterated Kalman update).
Ball Touching(const Ball& seen, const SurfaceAround& around, const HiddenContactTuning& tuning) {
  Ball ball = seen;
  for (int round = 0; round < tuning.touch_rounds; ++round) {
    const NearestSurface nearest = around.Nearest(ball.center_m);
    Eigen::Vector4d gradient;
    gradient << nearest.outward, -1.0;
    const double gap_m = nearest.height_m - ball.radius_m;
    Eigen::Vector4d from_seen;
    from_seen << ball.center_m - seen.center_m, ball.radius_m - seen.radius_m;
    const Eigen::Vector4d spread = seen.covariance_m2 * gradient;
    const Eigen::Vector4d gain =
        spread / (gradient.dot(spread) + tuning.surface_sigma_m * tuning.surface_sigma_m);
    const Eigen::Vector4d step = gain * (gradient.dot(from_seen) - gap_m);
    ball.center_m = seen.center_m + step.head<3>();
    ball.radius_m = seen.radius_m + step[3];
    ball.covariance_m2 = seen.covariance_m2 - gain * spread.transpose();
  }
  return ball;
}

struct Place {
  Eigen::Vector3d middle_m = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance_m2 = Eigen::Matrix3d::Zero();
};

/// Where a ball touches: the surface nearest to its centre, up to the uncertainty of the surface's
/// shape, for each sigma point of the centre. The result is wide along a flat surface, narrow
/// across a limb, and contains both sides of a corner.
std::optional<Place> TouchingPlace(const Ball& ball, const SurfaceAround& around,
                                   const HiddenContactTuning& tuning) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(ball.CenterCovariance_m2());
  Place place;
  Eigen::Matrix3d squares_m2 = Eigen::Matrix3d::Zero();
  for (int k = 0; k < 6; ++k) {
    const double sigma_m = std::sqrt(3.0 * std::max(0.0, axes.eigenvalues()[k / 2]));
    const Eigen::Vector3d center_m =
        ball.center_m + (k % 2 == 0 ? sigma_m : -sigma_m) * axes.eigenvectors().col(k / 2);
    const double least_m = std::abs(around.Nearest(center_m).height_m);
    double sum_m2 = 0.0;
    Eigen::Vector3d first_m = Eigen::Vector3d::Zero();
    Eigen::Matrix3d second_m2 = Eigen::Matrix3d::Zero();
    around.ForEachPart([&](const Eigen::Vector3d& part_m, double area_m2) {
      const double off = ((part_m - center_m).norm() - least_m) / tuning.shape_sigma_m;
      if (off > tuning.farthest_sigmas) return;
      const double weight_m2 = area_m2 * std::exp(-0.5 * off * off);
      const Eigen::Vector3d from_center_m = part_m - ball.center_m;
      sum_m2 += weight_m2;
      first_m += weight_m2 * from_center_m;
      second_m2 += weight_m2 * from_center_m * from_center_m.transpose();
    });
    if (!(sum_m2 > 0.0)) return std::nullopt;  // the uncertainty of the ball exceeds the surface
    place.middle_m += first_m / (6.0 * sum_m2);
    squares_m2 += second_m2 / (6.0 * sum_m2);
  }
  place.covariance_m2 = squares_m2 - place.middle_m * place.middle_m.transpose();
  place.middle_m += ball.center_m;
  return place;
}

std::optional<HiddenContact> TouchOnPlane(const Ball& ball, const rgbd::SensedCloud& robot,
                                          const Resolution& known,
                                          const HiddenContactTuning& tuning) {
  const Eigen::Matrix3Xd below_m = Near(robot, ball.center_m, ball.radius_m + tuning.plane_reach_m);
  if (below_m.cols() < tuning.fewest_below) return std::nullopt;
  const Plane plane = FitPlane(below_m, ball, tuning.plane_fade_m);
  const double turn_m = tuning.normal_sigma_rad * ball.radius_m;
  const double gap_m = plane.normal.dot(ball.center_m - plane.point_m) - ball.radius_m;
  return HiddenContact{
      .position_m = ball.center_m - ball.radius_m * plane.normal,
      .covariance_m2 = ball.CenterCovariance_m2() +
                       (turn_m * turn_m + known.Variance_m2()) * Eigen::Matrix3d::Identity(),
      .radius_m = ball.radius_m,
      .gap_m = gap_m,
      .touches = gap_m <= tuning.largest_gap * known.resolution_m};
}

std::optional<HiddenContact> TouchOnSurface(const Ball& seen, const PredictedSurface& surface,
                                            const HiddenContactTuning& tuning) {
  const SurfaceAround around(surface, seen.center_m, seen.radius_m + tuning.surface_reach_m,
                             tuning.around);
  if (around.empty()) return std::nullopt;
  const NearestSurface below = around.Nearest(seen.center_m);
  const double gap_m = below.height_m - seen.radius_m;
  const Ball ball = Touching(seen, around, tuning);
  if (!(ball.radius_m > 0.0) || !ball.center_m.allFinite()) return std::nullopt;
  const std::optional<Place> place = TouchingPlace(ball, around, tuning);
  if (!place) return std::nullopt;
  const Eigen::Vector3d across_m = tuning.surface_sigma_m * around.Nearest(place->middle_m).outward;
  return HiddenContact{
      .position_m = place->middle_m,
      .covariance_m2 = place->covariance_m2 + across_m * across_m.transpose(),
      .radius_m = ball.radius_m,
      .gap_m = gap_m,
      .touches = gap_m <= tuning.gap_sigmas * GapSigma_m(seen, below, tuning.surface_sigma_m)};
}

}  // namespace

std::optional<HiddenContact> FindHiddenContact(
    const rgbd::SensedCloud& robot, const rgbd::SensedCloud& object, const Eigen::Vector3d& rim_m,
    const PredictedSurface* surface, const Resolution& known, const HiddenContactTuning& tuning) {
  for (const double reach_m : tuning.reaches_m) {
    const std::optional<Ball> ball =
        FitBall(Near(object, rim_m, reach_m), known.noise_m, tuning.ball);
    if (!ball || !IsRound(*ball, known.noise_m, tuning)) continue;
    const auto contact = surface != nullptr ? TouchOnSurface(*ball, *surface, tuning)
                                            : TouchOnPlane(*ball, robot, known, tuning);
    if (contact) return contact;
  }
  return std::nullopt;
}

std::optional<HiddenContact> FindContactUnder(const Eigen::Matrix3Xd& points_m,
                                              const PredictedSurface& surface, double noise_m,
                                              const HiddenContactTuning& tuning) {
  const std::optional<Ball> ball = FitBall(points_m, noise_m, tuning.ball);
  if (!ball || !IsRound(*ball, noise_m, tuning)) return std::nullopt;
  auto contact = TouchOnSurface(*ball, surface, tuning);
  if (contact && !contact->touches) contact.reset();
  return contact;
}

}  // namespace palpate::perception
