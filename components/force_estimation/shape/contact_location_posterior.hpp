// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "components/force_estimation/shape/body_scale.hpp"
#include "components/force_estimation/shape/candidate_locations.hpp"
#include "components/force_estimation/shape/hidden_problem.hpp"

namespace palpate::force_estimation {

/// Where a contact is, as a distribution over the places of the surface.
struct ContactLocationPosterior {
  int place = -1;  ///< the most probable; -1: a push improves the fit nowhere
  PlaceFit fit;    ///< there
  /// Over the places around the best one, as far as a contact there counts as the same.
  Eigen::Vector3d mean_m = Eigen::Vector3d::Zero();
  /// The same weighted by the force at each place. The shape tells the moment: at the centre the
  /// force is the mean one, at the mean it would be smaller.
  Eigen::Vector3d centre_m = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance_m2 = Eigen::Matrix3d::Zero();  ///< about the centre, of all places
  double ci95_m = 0.0;  ///< radius around the centre that holds 95 %
  /// Mean square distance from the force at the centre, as the place is uncertain and each has
  /// a force of its own. Along that force: of the magnitude.
  Eigen::Matrix3d force_covariance_N2 = Eigen::Matrix3d::Zero();
};

/// Gaussian prior of a contact location.
struct PlacePrior {
  Eigen::Vector3d mean_m = Eigen::Vector3d::Zero();
  Eigen::Matrix3d information_m2 = Eigen::Matrix3d::Zero();  ///< 1/m^2; zero: no prior
};

/// How the posterior over the surface is computed.
struct ContactLocationTuning {
  /// Candidates within this evidence of the best, or this share of it, have plausible places around
  /// them: between candidates the evidence may be higher. Larger: more places are evaluated, fewer
  /// optima are missed.
  double plausible_fall = 20.0;
  double plausible_share = 0.3;
  /// Places of the first evaluation. More: slower, and a narrow optimum is missed less often.
  size_t most_first_places = 250;
  /// Radius around the best place that is then evaluated in full. Larger: slower, a finer
  /// posterior.
  double second_reach_strides = 2.0;
  /// Bound of minus twice the log prior of a place. Smaller: a contact may move farther in a frame;
  /// larger: an outdated prior holds it longer.
  double most_unlikely = 12.0;
  /// Model error and depth bias correlate over neighbouring rows: so many carry the information of
  /// one. Larger: wider posteriors.
  double correlated_rows = 6.0;
  /// Prior sigma of the force, of BodyScale::force_N. Smaller: places that need a large force lose
  /// probability.
  double usual_force_share = 0.032;
  /// Distance from the best place, of BodyScale::length_m, within which places are averaged.
  /// Larger: the mean of two separate optima lies between them.
  double same_location_share = 0.097;
};

/// Input of Locate.
struct LocateSettings {
  BodyScale scale = {};
  double friction = 0.0;  ///< sigma of the tangential over the normal force
  int unknowns = 3;       ///< fitted parameters; m less these are the degrees of freedom
  PlacePrior prior = {};
};

/// The probability of each place is proportional to its area and to exp(evidence / 2), all over the
/// residual's own scale where that is beyond the noise (model error). First the plausible part of
/// the surface is evaluated at a stride, then the surroundings of its best place in full. `usable`
/// [places]: where a contact may be.
ContactLocationPosterior Locate(const HiddenProblem& problem, const CandidateLocations& places,
                                const Eigen::Matrix3Xd& normals, const std::vector<bool>& usable,
                                const LocateSettings& settings,
                                const ContactLocationTuning& tuning = {});

}  // namespace palpate::force_estimation
