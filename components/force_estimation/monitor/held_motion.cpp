// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/monitor/held_motion.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <vector>

#include "libs/core/statistics.hpp"

namespace palpate::force_estimation {

namespace {

struct Row {
  Motion direction;  ///< of the distance along the normal, over its sigma
  double distance;   ///< over its sigma
};

struct Point {
  Eigen::Vector3d position_m;  ///< robot frame
  double sigma_m;              ///< of z in the camera's frame
};

/// Points that may lie on the fixed surface, thinned to at most most_points.
std::vector<Point> Candidates(const FixedSurfaceRegion& region, const rgbd::SensedCloud& cloud,
                              const Eigen::Isometry3d& T_robot_camera,
                              const HeldMotionTuning& tuning) {
  std::vector<Point> candidates;
  for (Eigen::Index k = 0; k < cloud.Count(); ++k) {
    const Eigen::Vector3d point_m = T_robot_camera * cloud.points_m.col(k).cast<double>();
    if (!region.MayHold(point_m, tuning.reach_m)) continue;
    candidates.push_back({point_m, static_cast<double>(cloud.sigma_m[k])});
  }
  const std::size_t stride = (candidates.size() + tuning.most_points - 1) / tuning.most_points;
  std::size_t kept = 0;
  for (std::size_t k = 0; k < candidates.size(); k += stride) candidates[kept++] = candidates[k];
  candidates.resize(kept);
  return candidates;
}

/// Matches the body, moved by `motion`, to the points: distances are those that remain.
std::vector<Row> Match(const FixedSurfaceRegion& region, const std::vector<Point>& points,
                       const Eigen::Isometry3d& T_robot_camera, const Eigen::VectorXd& x_m,
                       const Motion& motion, const HeldMotionTuning& tuning) {
  const Eigen::Vector3d optical_axis = T_robot_camera.linear().col(2);
  const Eigen::Vector3d middle_m = region.Middle_m();
  std::vector<Row> rows;
  for (const Point& point : points) {
    const Eigen::Vector3d from_middle_m = point.position_m - middle_m;
    const Eigen::Vector3d back_m =
        point.position_m - motion.head<3>().cross(from_middle_m) - motion.tail<3>();
    const auto place = region.PlaceOf(back_m, tuning.reach_m, x_m);
    if (!place) continue;
    const Eigen::Vector3d sight = (T_robot_camera.translation() - point.position_m).normalized();
    if (place->normal.dot(sight) < tuning.least_cosine) continue;
    // An error of z moves the point along its line of sight, by 1 / cosine to the optical axis.
    const double along = place->normal.dot(sight) / sight.dot(-optical_axis);
    const double sigma_m = std::hypot(along * point.sigma_m, tuning.surface_sigma_m);
    Row row;
    row.direction << from_middle_m.cross(place->normal), place->normal;
    row.direction /= sigma_m;
    row.distance = place->normal.dot(back_m - place->position_m) / sigma_m;
    rows.push_back(row);
  }
  return rows;
}

/// Adds the motion that minimises the distances.
void Refine(const std::vector<Row>& rows, const HeldMotionTuning& tuning, MotionSighting* seen) {
  Motion change = Motion::Zero();
  for (int round = 0; round < tuning.rounds; ++round) {
    seen->information = UnknownMotion(tuning);
    Motion pull = -seen->information * seen->motion;
    for (const Row& row : rows) {
      const double left = std::abs(row.distance - row.direction.dot(change));
      const double weight = HuberWeight(left, tuning.huber_sigmas);
      seen->information += weight * row.direction * row.direction.transpose();
      pull += weight * row.distance * row.direction;
    }
    change = Eigen::LDLT<Eigen::Matrix<double, 6, 6>>(seen->information).solve(pull);
  }
  seen->motion += change;
}

}  // namespace

Eigen::Matrix<double, 6, 6> UnknownMotion(const HeldMotionTuning& tuning) {
  Motion sigma;
  sigma << Eigen::Vector3d::Constant(tuning.prior_turn_rad),
      Eigen::Vector3d::Constant(tuning.prior_shift_m);
  return sigma.cwiseAbs2().cwiseInverse().asDiagonal();
}

MotionSighting SeeMotion(const FixedSurfaceRegion& region, const rgbd::SensedCloud& cloud,
                         const Eigen::Isometry3d& T_robot_camera, const Eigen::VectorXd& x_m,
                         const HeldMotionTuning& tuning) {
  MotionSighting seen;
  if (region.IsEmpty()) return seen;
  const std::vector<Point> points = Candidates(region, cloud, T_robot_camera, tuning);
  for (int match = 0; match < tuning.matchings; ++match) {
    const std::vector<Row> rows = Match(region, points, T_robot_camera, x_m, seen.motion, tuning);
    seen.points = static_cast<int>(rows.size());
    if (seen.points < tuning.least_points) return {.points = seen.points};
    const Motion before = seen.motion;
    Refine(rows, tuning, &seen);
    const Motion change = seen.motion - before;
    if (change.head<3>().norm() < tuning.same_turn_rad &&
        change.tail<3>().norm() < tuning.same_shift_m)
      break;
  }
  return seen;
}

}  // namespace palpate::force_estimation
