// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "components/force_estimation/shape/candidate_locations.hpp"
#include "components/force_estimation/shape/hidden_problem.hpp"

namespace palpate::force_estimation {

/// Where a contact is, as a distribution over the places of the surface.
struct ContactLocationPosterior {
  int place = -1;  ///< the best; -1: no place where a push would help
  PlaceFit fit;    ///< there
  /// Over the places around the best one, as far as a contact there would be taken for the same.
  Eigen::Vector3d mean_m = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance_m2 = Eigen::Matrix3d::Zero();  ///< about the mean, of all places
  double ci95_m = 0.0;  ///< radius around the mean that holds 95 %
  /// Mean square distance from the force at the mean place, because the place is not known: each
  /// has its own. Along that force: of the size.
  Eigen::Matrix3d force_covariance_N2 = Eigen::Matrix3d::Zero();
};

/// What was known of a place before, as a normal distribution in space.
struct PlacePrior {
  Eigen::Vector3d mean_m = Eigen::Vector3d::Zero();
  Eigen::Matrix3d information_m2 = Eigen::Matrix3d::Zero();  ///< 1/m^2; zero: nothing
};

/// What Locate goes by.
struct LocateSettings {
  double friction = 0.0;  ///< sigma of the tangential over the normal force
  int unknowns = 3;       ///< fitted of the residual: left over from m are its degrees of freedom
  PlacePrior prior = {};
};

/// The probability of each place is proportional to its area and to exp(evidence / 2), all over the
/// residual's own scale where that is beyond the noise, as of a model that is not exact. First the
/// plausible part of the surface is covered at a stride, then the surroundings of its best place in
/// full. `usable` [places]: where a contact may be.
ContactLocationPosterior Locate(const HiddenProblem& problem, const CandidateLocations& places,
                                const Eigen::Matrix3Xd& normals, const std::vector<bool>& usable,
                                const LocateSettings& settings);

}  // namespace palpate::force_estimation
