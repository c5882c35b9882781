// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/causes/placed_force.hpp"

#include <algorithm>
#include <limits>

#include "libs/robot/sensitivity/eyelet_gradient.hpp"

namespace palpate::diagnosis {

FaultParameter PlaceParameter(const std::string& name, double near_m) {
  return {.name = name, .nominal = near_m, .fault = kPlaceSigma_m, .qualifies = true};
}

PlacesToLookAt LookAt(const CauseWorld& world) {
  constexpr std::size_t kMost = 32;
  constexpr double kFarFromBase = 0.25;  // of the body's reach from the middle of its base
  PlacesToLookAt places;
  places.locator = std::make_shared<fem::PointLocator>(world.body.mesh);
  const Eigen::Vector3d middle_m = MiddleOfBase(world.body);
  Eigen::VectorXd least_m(std::ssize(world.body.feature_points));
  for (Eigen::Index k = 0; k < least_m.size(); ++k) {
    const auto& rest_m = world.body.feature_points[static_cast<std::size_t>(k)].rest_m;
    least_m[k] = std::numeric_limits<double>::infinity();
    for (int node = 0; node < world.body.mesh.NodeCount(); ++node) {
      if (!world.body.fixed.col(node).all()) continue;
      least_m[k] = std::min(least_m[k], (rest_m - world.body.mesh.nodes_m.col(node)).norm());
    }
  }
  const double reach_m = (world.body.mesh.nodes_m.colwise() - middle_m).colwise().norm().maxCoeff();
  for (Eigen::Index k = 0; k < least_m.size() && places.point_m.size() < kMost; ++k) {
    if (least_m[k] < kFarFromBase * reach_m) continue;
    places.point_m.push_back(world.body.feature_points[static_cast<std::size_t>(k)].rest_m);
  }
  return places;
}

robot::ParameterPtr MovedForce(const fem::PointLocator& locator, const Eigen::Vector3d& point_m,
                               int axis, const Eigen::Vector3d& force_N) {
  return PointForce(robot::EyeletWeightsAlong(locator, point_m, 0.0, Eigen::Vector3d::Unit(axis)),
                    force_N);
}

}  // namespace palpate::diagnosis
