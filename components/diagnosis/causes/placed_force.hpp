// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "components/diagnosis/causes/catalogue.hpp"
#include "libs/fem/embedding.hpp"

namespace palpate::diagnosis {

/// Forces at places that nobody knows are looked for near points spread over the body, and may act
/// up to so far from one of them, one sigma of each coordinate, m.
inline constexpr double kPlaceSigma_m = 0.012;

/// A coordinate of such a place, near `near_m`.
FaultParameter PlaceParameter(const std::string& name, double near_m);

struct PlacesToLookAt {
  std::vector<Eigen::Vector3d> point_m;  ///< of the undeformed body
  std::shared_ptr<const fem::PointLocator> locator;
};

/// Up to 32 of the body's feature points that are far from the held nodes, where forces move
/// little.
PlacesToLookAt LookAt(const CauseWorld& world);

/// Adds a cause of this kind, made of a point and the locator, for each place to look at.
template <typename PlacedCause>
void AddAtPlaces(const CauseWorld& world, std::vector<FaultModelPtr>* causes) {
  const PlacesToLookAt places = LookAt(world);
  for (const Eigen::Vector3d& point_m : places.point_m) {
    causes->push_back(std::make_unique<PlacedCause>(point_m, places.locator));
  }
}

/// What moving the point at which `force_N` acts along `axis` through the undeformed body does.
robot::ParameterPtr MovedForce(const fem::PointLocator& locator, const Eigen::Vector3d& point_m,
                               int axis, const Eigen::Vector3d& force_N);

}  // namespace palpate::diagnosis
