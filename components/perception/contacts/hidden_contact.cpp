// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/contacts/hidden_contact.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "components/perception/contacts/ball_fit.hpp"
#include "components/perception/contacts/surface_around.hpp"

namespace palpate::perception {

namespace {

/// How far around the rim the object is evaluated: all of a finger's tip, then a smaller thing on a
/// stem.
constexpr std::array kReaches_m = {0.02, 0.01};
constexpr double kNoises = 1.5;
constexpr double kOutOfRound = 0.05;   ///< of the radius
constexpr double kLargestSigma = 0.3;  ///< of the centre, in radii
/// Half a ball as a camera sees it has 0.5; a narrow strip of something else can look like part of
/// a much larger one.
constexpr double kLeastCovered = 0.25;
constexpr double kAround_m = 0.01;  ///< so far from the ball the robot's surface is evaluated,
constexpr double kFade_m = 0.005;   ///< the nearest points counting most
constexpr Eigen::Index kFewestBelow = 8;
/// The robot's surface under the ball is not seen: its normal is known to about this, rad.
constexpr double kTurnSigma = 0.2;
/// The predicted surface, once it is fitted to the frame, is known to about this.
constexpr double kSurfaceSigma_m = 1.2e-3;
/// Within a ball's width most of that error is the same: its shape there is known better.
constexpr double kShapeSigma_m = 0.6e-3;
constexpr double kFarthestInSigmas = 5.0;
constexpr double kGapSigmas = 3.0;
/// Without the predicted surface: a round object whose far side stays farther from the robot than
/// so many times the resolution of the clouds does not touch.
constexpr double kLargestGap = 1.5;
constexpr double kSurfaceReach_m = 0.02;
constexpr int kTouchRounds = 4;

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

bool IsRound(const Ball& ball, double noise_m) {
  const double largest_m = kLargestSigma * ball.radius_m;
  return ball.residual_m <= kNoises * noise_m + kOutOfRound * ball.radius_m &&
         ball.covered_m >= kLeastCovered * ball.radius_m &&
         ball.CenterCovariance_m2().trace() <= largest_m * largest_m;
}

struct Plane {
  Eigen::Vector3d point_m;
  Eigen::Vector3d normal;  ///< towards the ball
};

Plane FitPlane(const Eigen::Matrix3Xd& points_m, const Ball& ball) {
  const Eigen::RowVectorXd distance_m =
      (points_m.colwise() - ball.center_m).colwise().norm().array() - ball.radius_m;
  Eigen::RowVectorXd weight =
      (-distance_m.array().square() / (2.0 * kFade_m * kFade_m)).max(-100.0).exp();
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
double GapSigma_m(const Ball& ball, const NearestSurface& nearest) {
  Eigen::Vector4d gradient;
  gradient << nearest.outward, -1.0;
  return std::sqrt(gradient.dot(ball.covariance_m2 * gradient) + kSurfaceSigma_m * kSurfaceSigma_m);
}

/// What is known of the ball once it is taken to touch: of a small cap neither how large the ball
/// is nor how far behind the cap its middle lies, but for the surface that stops it. Gauss-Newton
/// from the ball as it was seen (iterated Kalman update).
Ball Touching(const Ball& seen, const SurfaceAround& around) {
  Ball ball = seen;
  for (int round = 0; round < kTouchRounds; ++round) {
    const NearestSurface nearest = around.Nearest(ball.center_m);
    Eigen::Vector4d gradient;
    gradient << nearest.outward, -1.0;
    const double gap_m = nearest.height_m - ball.radius_m;
    Eigen::Vector4d from_seen;
    from_seen << ball.center_m - seen.center_m, ball.radius_m - seen.radius_m;
    const Eigen::Vector4d spread = seen.covariance_m2 * gradient;
    const Eigen::Vector4d gain =
        spread / (gradient.dot(spread) + kSurfaceSigma_m * kSurfaceSigma_m);
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

/// Where a ball touches: the surface that is as near to its middle as any, to what the shape of the
/// surface is known to, for each of the sigma points of what is known of the middle. So it is wide
/// along a flat surface, narrow across a limb, and holds both sides of a corner that a ball lies
/// in.
std::optional<Place> TouchingPlace(const Ball& ball, const SurfaceAround& around) {
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
      const double off = ((part_m - center_m).norm() - least_m) / kShapeSigma_m;
      if (off > kFarthestInSigmas) return;
      const double weight_m2 = area_m2 * std::exp(-0.5 * off * off);
      const Eigen::Vector3d from_center_m = part_m - ball.center_m;
      sum_m2 += weight_m2;
      first_m += weight_m2 * from_center_m;
      second_m2 += weight_m2 * from_center_m * from_center_m.transpose();
    });
    if (!(sum_m2 > 0.0)) return std::nullopt;  // a ball that is known to no place at all
    place.middle_m += first_m / (6.0 * sum_m2);
    squares_m2 += second_m2 / (6.0 * sum_m2);
  }
  place.covariance_m2 = squares_m2 - place.middle_m * place.middle_m.transpose();
  place.middle_m += ball.center_m;
  return place;
}

std::optional<HiddenContact> TouchOnPlane(const Ball& ball, const rgbd::SensedCloud& robot,
                                          const Resolution& known) {
  const Eigen::Matrix3Xd below_m = Near(robot, ball.center_m, ball.radius_m + kAround_m);
  if (below_m.cols() < kFewestBelow) return std::nullopt;
  const Plane plane = FitPlane(below_m, ball);
  const double turn_m = kTurnSigma * ball.radius_m;
  const double gap_m = plane.normal.dot(ball.center_m - plane.point_m) - ball.radius_m;
  return HiddenContact{
      .position_m = ball.center_m - ball.radius_m * plane.normal,
      .covariance_m2 = ball.CenterCovariance_m2() +
                       (turn_m * turn_m + known.Variance_m2()) * Eigen::Matrix3d::Identity(),
      .radius_m = ball.radius_m,
      .gap_m = gap_m,
      .touches = gap_m <= kLargestGap * known.resolution_m};
}

std::optional<HiddenContact> TouchOnSkin(const Ball& seen, const PredictedSurface& surface) {
  const SurfaceAround around(surface, seen.center_m, seen.radius_m + kSurfaceReach_m);
  if (around.empty()) return std::nullopt;
  const NearestSurface below = around.Nearest(seen.center_m);
  const double gap_m = below.height_m - seen.radius_m;
  const Ball ball = Touching(seen, around);
  if (!(ball.radius_m > 0.0) || !ball.center_m.allFinite()) return std::nullopt;
  const std::optional<Place> place = TouchingPlace(ball, around);
  if (!place) return std::nullopt;
  const Eigen::Vector3d across_m = kSurfaceSigma_m * around.Nearest(place->middle_m).outward;
  return HiddenContact{.position_m = place->middle_m,
                       .covariance_m2 = place->covariance_m2 + across_m * across_m.transpose(),
                       .radius_m = ball.radius_m,
                       .gap_m = gap_m,
                       .touches = gap_m <= kGapSigmas * GapSigma_m(seen, below)};
}

}  // namespace

std::optional<HiddenContact> FindHiddenContact(const rgbd::SensedCloud& robot,
                                               const rgbd::SensedCloud& object,
                                               const Eigen::Vector3d& rim_m,
                                               const PredictedSurface* surface,
                                               const Resolution& known) {
  for (const double reach_m : kReaches_m) {
    const std::optional<Ball> ball = FitBall(Near(object, rim_m, reach_m), known.noise_m);
    if (!ball || !IsRound(*ball, known.noise_m)) continue;
    const auto contact =
        surface != nullptr ? TouchOnSkin(*ball, *surface) : TouchOnPlane(*ball, robot, known);
    if (contact) return contact;
  }
  return std::nullopt;
}

std::optional<HiddenContact> FindContactUnder(const Eigen::Matrix3Xd& points_m,
                                              const PredictedSurface& surface, double noise_m) {
  const std::optional<Ball> ball = FitBall(points_m, noise_m);
  if (!ball || !IsRound(*ball, noise_m)) return std::nullopt;
  auto contact = TouchOnSkin(*ball, surface);
  if (contact && !contact->touches) contact.reset();
  return contact;
}

}  // namespace palpate::perception
