// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/monitor/held_motion.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <vector>

#include "libs/core/statistics.hpp"

namespace palpate::force_estimation {

namespace {

/// A point farther off than this is of something else.
constexpr double kReach_m = 6e-3;
/// Skin at a more grazing angle is not matched: cosine to the line of sight.
constexpr double kGrazing = 0.25;
constexpr double kSkin_m = 3e-4;
constexpr double kHuber = 2.0;
constexpr int kRounds = 3;
constexpr int kMatches = 3;
constexpr int kLeastPoints = 30;
constexpr std::size_t kMostPoints = 500;
constexpr double kUnknownTurn_rad = 0.1;
constexpr double kUnknownShift_m = 0.05;

/// A motion that changes by less is not matched anew: the facets are longer by far.
constexpr double kSameTurn_rad = 4e-3;
constexpr double kSameShift_m = 5e-4;

struct Row {
  Motion direction;  ///< of the distance along the normal, over its sigma
  double distance;   ///< over its sigma
};

struct Point {
  Eigen::Vector3d position_m;  ///< robot frame
  double sigma_m;              ///< of z in the camera's frame
};

/// Points that may lie on the held skin; every so many-th, so that no more than kMostPoints are
/// left.
std::vector<Point> Candidates(const FixedSurfaceRegion& skin, const rgbd::SensedCloud& cloud,
                              const Eigen::Isometry3d& T_robot_camera) {
  std::vector<Point> candidates;
  for (Eigen::Index k = 0; k < cloud.Count(); ++k) {
    const Eigen::Vector3d point_m = T_robot_camera * cloud.points_m.col(k).cast<double>();
    if (!skin.MayHold(point_m, kReach_m)) continue;
    candidates.push_back({point_m, static_cast<double>(cloud.sigma_m[k])});
  }
  const std::size_t stride = (candidates.size() + kMostPoints - 1) / kMostPoints;
  std::size_t kept = 0;
  for (std::size_t k = 0; k < candidates.size(); k += stride) candidates[kept++] = candidates[k];
  candidates.resize(kept);
  return candidates;
}

/// The body that moved by `motion`, matched to the points: distances are those left.
std::vector<Row> Match(const FixedSurfaceRegion& skin, const std::vector<Point>& points,
                       const Eigen::Isometry3d& T_robot_camera, const Eigen::VectorXd& x_m,
                       const Motion& motion) {
  const Eigen::Vector3d optical_axis = T_robot_camera.linear().col(2);
  const Eigen::Vector3d middle_m = skin.Middle_m();
  std::vector<Row> rows;
  for (const Point& point : points) {
    const Eigen::Vector3d from_middle_m = point.position_m - middle_m;
    const Eigen::Vector3d back_m =
        point.position_m - motion.head<3>().cross(from_middle_m) - motion.tail<3>();
    const auto place = skin.PlaceOf(back_m, kReach_m, x_m);
    if (!place) continue;
    const Eigen::Vector3d sight = (T_robot_camera.translation() - point.position_m).normalized();
    if (place->normal.dot(sight) < kGrazing) continue;
    // An error of z moves the point along its line of sight, by 1 / cosine to the optical axis.
    const double along = place->normal.dot(sight) / sight.dot(-optical_axis);
    const double sigma_m = std::hypot(along * point.sigma_m, kSkin_m);
    Row row;
    row.direction << from_middle_m.cross(place->normal), place->normal;
    row.direction /= sigma_m;
    row.distance = place->normal.dot(back_m - place->position_m) / sigma_m;
    rows.push_back(row);
  }
  return rows;
}

/// Adds to the motion what the distances ask for.
void Refine(const std::vector<Row>& rows, MotionSighting* seen) {
  Motion change = Motion::Zero();
  for (int round = 0; round < kRounds; ++round) {
    seen->information = UnknownMotion();
    Motion pull = -seen->information * seen->motion;
    for (const Row& row : rows) {
      const double left = std::abs(row.distance - row.direction.dot(change));
      const double weight = HuberWeight(left, kHuber);
      seen->information += weight * row.direction * row.direction.transpose();
      pull += weight * row.distance * row.direction;
    }
    change = Eigen::LDLT<Eigen::Matrix<double, 6, 6>>(seen->information).solve(pull);
  }
  seen->motion += change;
}

}  // namespace

Eigen::Matrix<double, 6, 6> UnknownMotion() {
  Motion sigma;
  sigma << Eigen::Vector3d::Constant(kUnknownTurn_rad), Eigen::Vector3d::Constant(kUnknownShift_m);
  return sigma.cwiseAbs2().cwiseInverse().asDiagonal();
}

MotionSighting SeeMotion(const FixedSurfaceRegion& skin, const rgbd::SensedCloud& cloud,
                         const Eigen::Isometry3d& T_robot_camera, const Eigen::VectorXd& x_m) {
  MotionSighting seen;
  if (skin.IsEmpty()) return seen;
  const std::vector<Point> points = Candidates(skin, cloud, T_robot_camera);
  for (int match = 0; match < kMatches; ++match) {
    const std::vector<Row> rows = Match(skin, points, T_robot_camera, x_m, seen.motion);
    seen.points = static_cast<int>(rows.size());
    if (seen.points < kLeastPoints) return {.points = seen.points};
    const Motion before = seen.motion;
    Refine(rows, &seen);
    const Motion change = seen.motion - before;
    if (change.head<3>().norm() < kSameTurn_rad && change.tail<3>().norm() < kSameShift_m) break;
  }
  return seen;
}

}  // namespace palpate::force_estimation
