// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/shape/contact_location_posterior.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "libs/core/index.hpp"

namespace palpate::force_estimation {

namespace {

/// The evaluation of one place.
struct Evaluation {
  int place = -1;
  double share = 1.0;  ///< of the surface, in places
  PlaceFit fit;
  double unlikely = 0.0;  ///< minus twice the log of the prior of place and force

  double evidence() const { return fit.evidence - unlikely; }
};

class Locator {
 public:
  Locator(const HiddenProblem& problem, const CandidateLocations& places,
          const Eigen::Matrix3Xd& normals, const std::vector<bool>& usable,
          const LocateSettings& settings, const ContactLocationTuning& tuning)
      : problem_(problem),
        places_(places),
        normals_(normals),
        usable_(usable),
        settings_(settings),
        tuning_(tuning),
        usual_force_N_(tuning.usual_force_share * settings.scale.force_N) {}

  std::vector<Evaluation> EvaluatePlausible() const {
    const std::vector<int> plausible = PlausiblePlaces();
    if (plausible.empty()) return {};
    const size_t stride =
        (plausible.size() + tuning_.most_first_places - 1) / tuning_.most_first_places;
    std::vector<int> first;
    for (size_t k = 0; k < plausible.size(); k += stride) first.push_back(plausible[k]);
    std::vector<Evaluation> evaluations = Evaluate(first);
    if (stride == 1) return evaluations;
    const Eigen::Vector3d best_m = places_.positions_m().col(Best(evaluations).place);
    const double reach_m =
        tuning_.second_reach_strides * places_.spacing_m() * std::sqrt(static_cast<double>(stride));
    const auto is_far = [&](int place) {
      return (places_.positions_m().col(place) - best_m).norm() > reach_m;
    };
    std::erase_if(evaluations, [&](const Evaluation& one) { return !is_far(one.place); });
    for (Evaluation& one : evaluations) one.share = static_cast<double>(stride);
    std::vector<int> near = plausible;
    std::erase_if(near, is_far);
    const std::vector<Evaluation> second = Evaluate(near);
    evaluations.insert(evaluations.end(), second.begin(), second.end());
    return evaluations;
  }

  static const Evaluation& Best(const std::vector<Evaluation>& evaluations) {
    return *std::max_element(
        evaluations.begin(), evaluations.end(),
        [](const Evaluation& a, const Evaluation& b) { return a.evidence() < b.evidence(); });
  }

 private:
  std::vector<Evaluation> Evaluate(const std::vector<int>& places) const {
    const std::vector<PlaceEquations> equations = problem_.EquationsAt(places);
    std::vector<Evaluation> evaluations;
    for (size_t k = 0; k < places.size(); ++k) {
      Evaluation one{.place = places[k], .share = 1.0, .fit = {}, .unlikely = Unlikely(places[k])};
      one.fit = FitPush(equations[k], normals_.col(one.place), settings_.friction);
      one.unlikely += std::pow(one.fit.force_N / usual_force_N_, 2);
      evaluations.push_back(one);
    }
    return evaluations;
  }

  /// Squared distance from the prior's mean, in its sigmas, up to a bound: the prior may be wrong.
  double Unlikely(int place) const {
    const Eigen::Vector3d off_m = places_.positions_m().col(place) - settings_.prior.mean_m;
    return std::min(tuning_.most_unlikely, off_m.dot(settings_.prior.information_m2 * off_m));
  }

  std::vector<int> PlausiblePlaces() const {
    const int count = places_.CandidateCount();
    std::vector<int> candidates;
    std::vector<int> usable;
    for (int c = 0; c < count; ++c) {
      const int place = places_.PlaceOfCandidate(c);
      if (!usable_[At(place)]) continue;
      candidates.push_back(c);
      usable.push_back(place);
    }
    const std::vector<Evaluation> evaluations = Evaluate(usable);
    std::vector<double> evidence(static_cast<size_t>(count), 0.0);
    for (size_t k = 0; k < evaluations.size(); ++k) {
      evidence[At(candidates[k])] = evaluations[k].evidence();
    }
    const double best = *std::max_element(evidence.begin(), evidence.end());
    const double least = best - std::max(tuning_.plausible_fall, tuning_.plausible_share * best);
    std::vector<int> plausible;
    for (int place = 0; place < places_.Count(); ++place) {
      if (!usable_[At(place)]) continue;
      const auto& around = places_.NearestCandidates(place);
      const bool any = std::any_of(around.begin(), around.end(),
                                   [&](int candidate) { return evidence[At(candidate)] >= least; });
      if (any) plausible.push_back(place);
    }
    return plausible;
  }

  const HiddenProblem& problem_;
  const CandidateLocations& places_;
  const Eigen::Matrix3Xd& normals_;
  const std::vector<bool>& usable_;
  const LocateSettings& settings_;
  const ContactLocationTuning& tuning_;
  double usual_force_N_;
};

/// Radius around `centre_m` that holds 95 % of the shares.
double Radius95_m(const std::vector<Evaluation>& evaluations,
                  const std::vector<double>& probability, const Eigen::Matrix3Xd& positions_m,
                  const Eigen::Vector3d& centre_m) {
  std::vector<std::pair<double, double>> by_distance;
  for (size_t k = 0; k < evaluations.size(); ++k) {
    by_distance.emplace_back((positions_m.col(evaluations[k].place) - centre_m).norm(),
                             probability[k]);
  }
  std::sort(by_distance.begin(), by_distance.end());
  double held = 0.0;
  for (const auto& [distance_m, share] : by_distance) {
    held += share;
    if (held >= 0.95) return distance_m;
  }
  return by_distance.back().first;
}

/// Mean and centre of the places, and the mean square distances of place and force from the centre
/// and from the force there, which are reported. Along that force the covariance has the spread of
/// the magnitudes: places with another normal have forces of which only a part lies along it.
void Summarise(const std::vector<Evaluation>& evaluations, const std::vector<double>& probability,
               const CandidateLocations& places, const Eigen::Matrix3Xd& normals,
               double same_location_m, ContactLocationPosterior* posterior) {
  const Eigen::Vector3d best_m = places.positions_m().col(posterior->place);
  double same = 0.0;
  double same_N = 0.0;
  for (size_t k = 0; k < evaluations.size(); ++k) {
    const Eigen::Vector3d place_m = places.positions_m().col(evaluations[k].place);
    if ((place_m - best_m).norm() > same_location_m) continue;
    const double weight_N = probability[k] * evaluations[k].fit.force_N;
    same += probability[k];
    same_N += weight_N;
    posterior->mean_m += probability[k] * place_m;
    posterior->centre_m += weight_N * place_m;
  }
  posterior->mean_m /= same;
  posterior->centre_m /= same_N;
  const auto off_centre_m = [&](const Evaluation& one) -> Eigen::Vector3d {
    return places.positions_m().col(one.place) - posterior->centre_m;
  };
  const auto force_N = [&](const Evaluation& one) -> Eigen::Vector3d {
    return one.fit.tangential_N - one.fit.force_N * normals.col(one.place);
  };
  const Eigen::Vector3d there_N = force_N(*std::min_element(
      evaluations.begin(), evaluations.end(), [&](const Evaluation& a, const Evaluation& b) {
        return off_centre_m(a).squaredNorm() < off_centre_m(b).squaredNorm();
      }));
  double size_variance_N2 = 0.0;
  for (size_t k = 0; k < evaluations.size(); ++k) {
    const Eigen::Vector3d off_m = off_centre_m(evaluations[k]);
    const Eigen::Vector3d off_N = force_N(evaluations[k]) - there_N;
    const double larger_N = force_N(evaluations[k]).norm() - there_N.norm();
    posterior->covariance_m2 += probability[k] * off_m * off_m.transpose();
    posterior->force_covariance_N2 += probability[k] * off_N * off_N.transpose();
    size_variance_N2 += probability[k] * larger_N * larger_N;
  }
  const Eigen::Vector3d along = there_N.normalized();
  const double has_N2 = along.dot(posterior->force_covariance_N2 * along);
  posterior->force_covariance_N2 +=
      std::max(0.0, size_variance_N2 - has_N2) * along * along.transpose();
}

}  // namespace

ContactLocationPosterior Locate(const HiddenProblem& problem, const CandidateLocations& places,
                                const Eigen::Matrix3Xd& normals, const std::vector<bool>& usable,
                                const LocateSettings& settings,
                                const ContactLocationTuning& tuning) {
  const Locator locator(problem, places, normals, usable, settings, tuning);
  const std::vector<Evaluation> evaluations = locator.EvaluatePlausible();
  if (evaluations.empty()) return {};
  const Evaluation& best = Locator::Best(evaluations);
  if (!(best.fit.force_N > 0.0)) return {};
  const double freedom =
      std::max(1.0, static_cast<double>(problem.residual().size()) - settings.unknowns);
  const double left = problem.residual().squaredNorm() - best.fit.gain;
  const double noise_scale = tuning.correlated_rows * std::max(1.0, left / freedom);
  std::vector<double> probability;
  for (const Evaluation& one : evaluations) {
    const bool pushes = one.fit.force_N > 0.0;
    const double fall = one.fit.evidence - best.fit.evidence;
    const double before = best.unlikely - one.unlikely;
    probability.push_back(pushes ? one.share * std::exp(0.5 * (fall / noise_scale + before)) : 0.0);
  }
  const double sum = std::accumulate(probability.begin(), probability.end(), 0.0);
  for (double& share : probability) share /= sum;

  ContactLocationPosterior posterior{.place = best.place, .fit = best.fit};
  Summarise(evaluations, probability, places, normals,
            tuning.same_location_share * settings.scale.length_m, &posterior);
  const double between_m2 = places.spacing_m() * places.spacing_m() / 12.0;
  posterior.covariance_m2 += between_m2 * Eigen::Matrix3d::Identity();
  posterior.ci95_m =
      std::max(Radius95_m(evaluations, probability, places.positions_m(), posterior.centre_m),
               places.spacing_m());
  return posterior;
}

}  // namespace palpate::force_estimation
