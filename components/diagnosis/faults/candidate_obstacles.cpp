// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/faults/candidate_obstacles.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace palpate::diagnosis {

namespace {

constexpr int kDirections = 250;             ///< some 13 degrees from each other
constexpr std::size_t kMostWays = 16;        ///< directions that are evaluated
constexpr double kBeside = 0.9;              ///< cosine; ways are farther than that from each other
constexpr double kLeastTravel_m = 5e-4;      ///< an obstacle would move markers by less than noise
constexpr double kGaps[] = {0.1, 0.3, 0.6};  ///< of how far the body goes
constexpr double kGapSigma = 0.15;

/// Spread evenly over the sphere (R. Swinbank and R. J. Purser, Fibonacci grids, Q. J. R. Meteorol.
/// Soc. 132, 2006).
Eigen::Vector3d Direction(int k) {
  const double z = 1.0 - (2.0 * k + 1.0) / kDirections;
  const double azimuth_rad = 2.0 * std::numbers::pi * k / std::numbers::phi;
  const double radius = std::sqrt(1.0 - z * z);
  return {radius * std::cos(azimuth_rad), radius * std::sin(azimuth_rad), z};
}

struct Way {
  Eigen::Vector3d normal;  ///< of an obstacle that would end it
  double nearest_m = 0.0;  ///< normal' x of the undeformed body
  double travel_m = 0.0;   ///< against the normal, from there
};

/// The farthest first.
std::vector<Way> FarthestWays(const ObstacleSurface& surface, const Eigen::VectorXd& undeformed_m,
                              const Simulation& as_built) {
  std::vector<Way> ways;
  for (int k = 0; k < kDirections; ++k) {
    Way way{.normal = Direction(k)};
    way.nearest_m = NearestAlong(surface, way.normal, undeformed_m);
    for (const SimulatedSample& sample : as_built.samples) {
      if (!sample.status.ok()) continue;
      const double reached_m = NearestAlong(surface, way.normal, sample.middle.state.x_m);
      way.travel_m = std::max(way.travel_m, way.nearest_m - reached_m);
    }
    if (way.travel_m > kLeastTravel_m) ways.push_back(way);
  }
  std::sort(ways.begin(), ways.end(),
            [](const Way& a, const Way& b) { return a.travel_m > b.travel_m; });
  std::vector<Way> apart;
  for (const Way& way : ways) {
    const bool beside = std::any_of(apart.begin(), apart.end(), [&](const Way& other) {
      return way.normal.dot(other.normal) > kBeside;
    });
    if (!beside && apart.size() < kMostWays) apart.push_back(way);
  }
  return apart;
}

/// The middle of what goes beyond an obstacle, the deeper and the longer the more, moved onto it.
Eigen::Vector3d MiddleOn(const Obstacle& obstacle, const Simulation& as_built) {
  Eigen::Vector3d sum_m = Eigen::Vector3d::Zero();
  double weight = 0.0;
  for (const SimulatedSample& sample : as_built.samples) {
    if (!sample.status.ok()) continue;
    const Beyond beyond = BeyondObstacle(obstacle, sample.middle.state.x_m);
    sum_m += beyond.depth_m * beyond.middle_m;
    weight += beyond.depth_m;
  }
  const Eigen::Vector3d middle_m = sum_m / weight;
  return middle_m + (obstacle.offset_m - obstacle.normal.dot(middle_m)) * obstacle.normal;
}

}  // namespace

Beyond BeyondObstacle(const Obstacle& obstacle, const Eigen::VectorXd& x_m) {
  Beyond beyond;
  double sum_m = 0.0;
  for (const int node : obstacle.surface->nodes) {
    const double depth_m = obstacle.Depth_m(node, x_m);
    if (depth_m <= 0.0) continue;
    beyond.share.emplace_back(node, depth_m);
    sum_m += depth_m;
  }
  for (auto& [node, share] : beyond.share) {
    const double depth_m = share;
    share /= sum_m;
    beyond.depth_m += share * depth_m;
    beyond.middle_m += share * x_m.segment<3>(3 * node);
  }
  return beyond;
}

std::vector<CandidateObstacle> CandidateObstacles(
    const std::shared_ptr<const ObstacleSurface>& surface, const Eigen::VectorXd& undeformed_m,
    const Simulation& as_built) {
  std::vector<CandidateObstacle> obstacles;
  int number = 0;
  for (const Way& way : FarthestWays(*surface, undeformed_m, as_built)) {
    for (const double share : kGaps) {
      const double gap_m = share * way.travel_m;
      const Obstacle obstacle{surface, way.normal, way.nearest_m - gap_m};
      obstacles.push_back({.way = number,
                           .normal = way.normal,
                           .middle_m = MiddleOn(obstacle, as_built),
                           .gap_m = gap_m,
                           .shift_sigma_m = kGapSigma * way.travel_m,
                           .most_shift_m = way.travel_m - gap_m});
    }
    ++number;
  }
  return obstacles;
}

}  // namespace palpate::diagnosis
