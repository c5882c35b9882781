// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/contacts/hidden_contact.hpp"

#include <Eigen/Eigenvalues>
#include <array>
#include <cmath>
#include <vector>

#include "components/perception/contacts/ball_fit.hpp"
#include "libs/geometry/closest_point.hpp"

namespace palpate::perception {

namespace {

/// How far around the rim the object is looked at: all of a finger's tip, then a smaller thing on a
/// stem.
constexpr std::array kReaches_m = {0.02, 0.01};
constexpr double kNoises = 1.5;
constexpr double kOutOfRound = 0.05;   ///< of the radius
constexpr double kLargestSigma = 0.3;  ///< of the centre, in radii
/// Half a ball as a camera sees it has 0.5; a narrow strip of something else can look like part of
/// a much larger one.
constexpr double kLeastCovered = 0.25;
constexpr double kAround_m = 0.01;  ///< so far from the ball the robot's surface is looked at,
constexpr double kFade_m = 0.005;   ///< the nearest points counting most
constexpr Eigen::Index kFewestBelow = 8;
/// The robot's surface under the ball is not seen: its normal is known to about this, rad.
constexpr double kTurnSigma = 0.2;
/// The predicted surface, once it is fitted to the frame, is known to about this.
constexpr double kSurfaceSigma_m = 1.2e-3;
constexpr double kGapSigmas = 3.0;

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
         ball.center_covariance_m2.trace() <= largest_m * largest_m;
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

Eigen::Vector3d NearestOn(const PredictedSurface& surface, const Eigen::Vector3d& place_m) {
  Eigen::Vector3d nearest_m = Eigen::Vector3d::Constant(1e3);
  for (const auto& corners : surface.triangles.colwise()) {
    const Eigen::Matrix3d triangle_m = surface.vertices_m(Eigen::all, corners);
    const Eigen::Vector3d point_m =
        triangle_m * geometry::ClosestPointOnTriangle(triangle_m.col(0), triangle_m.col(1),
                                                      triangle_m.col(2), place_m);
    if ((point_m - place_m).squaredNorm() < (nearest_m - place_m).squaredNorm()) {
      nearest_m = point_m;
    }
  }
  return nearest_m;
}

}  // namespace

std::optional<HiddenContact> FindHiddenContact(const rgbd::SensedCloud& robot,
                                               const rgbd::SensedCloud& object,
                                               const Eigen::Vector3d& rim_m, double noise_m) {
  for (const double reach_m : kReaches_m) {
    const std::optional<Ball> ball = FitBall(Near(object, rim_m, reach_m), noise_m);
    if (!ball || !IsRound(*ball, noise_m)) continue;
    const Eigen::Matrix3Xd below_m = Near(robot, ball->center_m, ball->radius_m + kAround_m);
    if (below_m.cols() < kFewestBelow) continue;
    const Plane plane = FitPlane(below_m, *ball);
    const double turn_m = kTurnSigma * ball->radius_m;
    HiddenContact contact;
    contact.radius_m = ball->radius_m;
    contact.position_m = ball->center_m - ball->radius_m * plane.normal;
    contact.covariance_m2 =
        ball->center_covariance_m2 + turn_m * turn_m * Eigen::Matrix3d::Identity();
    contact.gap_m = plane.normal.dot(ball->center_m - plane.point_m) - ball->radius_m;
    return contact;
  }
  return std::nullopt;
}

std::optional<HiddenContact> FindContactUnder(const Eigen::Matrix3Xd& points_m,
                                              const PredictedSurface& surface, double noise_m) {
  const std::optional<Ball> ball = FitBall(points_m, noise_m);
  if (!ball || !IsRound(*ball, noise_m)) return std::nullopt;
  const Eigen::Vector3d nearest_m = NearestOn(surface, ball->center_m);
  const double distance_m = (nearest_m - ball->center_m).norm();
  if (!(distance_m > 0.0)) return std::nullopt;
  const Eigen::Vector3d down = (nearest_m - ball->center_m) / distance_m;
  HiddenContact contact;
  contact.radius_m = ball->radius_m;
  contact.position_m = ball->center_m + ball->radius_m * down;
  contact.gap_m = distance_m - ball->radius_m;
  const double turn_m = kTurnSigma * ball->radius_m;
  contact.covariance_m2 =
      ball->center_covariance_m2 + turn_m * turn_m * Eigen::Matrix3d::Identity();
  const double along_m2 = down.dot(ball->center_covariance_m2 * down);
  const double sigma_m = std::sqrt(along_m2 + kSurfaceSigma_m * kSurfaceSigma_m);
  if (contact.gap_m > kGapSigmas * sigma_m) return std::nullopt;
  return contact;
}

}  // namespace palpate::perception
