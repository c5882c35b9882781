// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <memory>
#include <utility>
#include <vector>

#include "components/diagnosis/forward/obstacle.hpp"
#include "components/diagnosis/forward/simulation.hpp"

namespace palpate::diagnosis {

/// An obstacle that would be met in an experiment, near which one is searched.
struct CandidateObstacle {
  int way = 0;                 ///< number of the direction
  Eigen::Vector3d normal;      ///< unit, towards the body
  Eigen::Vector3d middle_m;    ///< of where it would be met, on it
  double gap_m = 0.0;          ///< from the undeformed body
  double shift_sigma_m = 0.0;  ///< how far it may be from there along the normal
  double most_shift_m = 0.0;   ///< beyond, nothing touches it
};

/// Nodes of a body that are beyond an obstacle.
struct Beyond {
  std::vector<std::pair<int, double>> share;           ///< (node, of all depth)
  double depth_m = 0.0;                                ///< mean by these shares
  Eigen::Vector3d middle_m = Eigen::Vector3d::Zero();  ///< of them, by these shares
};
Beyond BeyondObstacle(const Obstacle& obstacle, const Eigen::VectorXd& x_m);

/// In the directions in which the body goes farthest out of where it is undeformed, some gaps up to
/// how far it goes. `undeformed_m` [3n].
std::vector<CandidateObstacle> CandidateObstacles(
    const std::shared_ptr<const ObstacleSurface>& surface, const Eigen::VectorXd& undeformed_m,
    const Simulation& as_built);

}  // namespace palpate::diagnosis
