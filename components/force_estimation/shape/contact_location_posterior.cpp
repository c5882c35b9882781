// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/shape/contact_location_posterior.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace palpate::force_estimation {

namespace {

/// Candidates whose evidence falls short of the best by no more than this, or this part of it, have
/// plausible places around them: between candidates the evidence may be higher.
constexpr double kPlausibleFall = 20.0;
constexpr double kPlausiblePart = 0.3;
/// Places that the first look takes at most, and how far around its best the second goes, in
/// strides.
constexpr size_t kFirstLook = 250;
constexpr double kSecondLook = 2.0;
/// Of a place far from what was known before: minus twice the log of the chance that that is wrong.
constexpr double kMostUnlikely = 12.0;
/// What is left of model and depth bias is alike in neighbouring rows: so many of them tell as much
/// as one.
constexpr double kRowsAlike = 6.0;
/// Sigma of the force of a contact of which nothing else is known.
constexpr double kUsualForce_N = 1.0;
/// Places so near to the best one are averaged.
constexpr double kSameLocation_m = 0.03;

struct Look {
  int place = -1;
  double share = 1.0;  ///< of the surface, in places
  PlaceFit fit;
  double unlikely = 0.0;  ///< of the place, before: minus twice the log of its prior

  double evidence() const { return fit.evidence - unlikely; }
};

class Locator {
 public:
  Locator(const HiddenProblem& problem, const CandidateLocations& places,
          const Eigen::Matrix3Xd& normals, const std::vector<bool>& usable,
          const LocateSettings& settings)
      : problem_(problem),
        places_(places),
        normals_(normals),
        usable_(usable),
        settings_(settings) {}

  std::vector<Look> LookAround() const {
    const std::vector<int> plausible = PlausiblePlaces();
    if (plausible.empty()) return {};
    const size_t stride = (plausible.size() + kFirstLook - 1) / kFirstLook;
    std::vector<int> first;
    for (size_t k = 0; k < plausible.size(); k += stride) first.push_back(plausible[k]);
    std::vector<Look> looks = LookAt(first);
    if (stride == 1) return looks;
    const Eigen::Vector3d best_m = places_.positions_m().col(Best(looks).place);
    const double reach_m =
        kSecondLook * places_.spacing_m() * std::sqrt(static_cast<double>(stride));
    const auto is_far = [&](int place) {
      return (places_.positions_m().col(place) - best_m).norm() > reach_m;
    };
    std::erase_if(looks, [&](const Look& look) { return !is_far(look.place); });
    for (Look& look : looks) look.share = static_cast<double>(stride);
    std::vector<int> near = plausible;
    std::erase_if(near, is_far);
    const std::vector<Look> second = LookAt(near);
    looks.insert(looks.end(), second.begin(), second.end());
    return looks;
  }

  static const Look& Best(const std::vector<Look>& looks) {
    return *std::max_element(looks.begin(), looks.end(), [](const Look& a, const Look& b) {
      return a.evidence() < b.evidence();
    });
  }

 private:
  std::vector<Look> LookAt(const std::vector<int>& places) const {
    const std::vector<PlaceEquations> equations = problem_.EquationsAt(places);
    std::vector<Look> looks;
    for (size_t k = 0; k < places.size(); ++k) {
      Look look{.place = places[k], .share = 1.0, .fit = {}, .unlikely = Unlikely(places[k])};
      look.fit = FitPush(equations[k], normals_.col(look.place), settings_.friction);
      look.unlikely += std::pow(look.fit.force_N / kUsualForce_N, 2);
      looks.push_back(look);
    }
    return looks;
  }

  /// Squared distance from what was known before, in its sigmas; what was known may be wrong.
  double Unlikely(int place) const {
    const Eigen::Vector3d off_m = places_.positions_m().col(place) - settings_.prior.mean_m;
    return std::min(kMostUnlikely, off_m.dot(settings_.prior.information_m2 * off_m));
  }

  std::vector<int> PlausiblePlaces() const {
    const int count = places_.CandidateCount();
    std::vector<int> candidates;
    std::vector<int> usable;
    for (int c = 0; c < count; ++c) {
      const int place = places_.PlaceOfCandidate(c);
      if (!usable_[static_cast<size_t>(place)]) continue;
      candidates.push_back(c);
      usable.push_back(place);
    }
    const std::vector<Look> looks = LookAt(usable);
    std::vector<double> evidence(static_cast<size_t>(count), 0.0);
    for (size_t k = 0; k < looks.size(); ++k) {
      evidence[static_cast<size_t>(candidates[k])] = looks[k].evidence();
    }
    const double best = *std::max_element(evidence.begin(), evidence.end());
    const double least = best - std::max(kPlausibleFall, kPlausiblePart * best);
    std::vector<int> plausible;
    for (int place = 0; place < places_.Count(); ++place) {
      if (!usable_[static_cast<size_t>(place)]) continue;
      const auto& around = places_.NearestCandidates(place);
      const bool any = std::any_of(around.begin(), around.end(), [&](int candidate) {
        return evidence[static_cast<size_t>(candidate)] >= least;
      });
      if (any) plausible.push_back(place);
    }
    return plausible;
  }

  const HiddenProblem& problem_;
  const CandidateLocations& places_;
  const Eigen::Matrix3Xd& normals_;
  const std::vector<bool>& usable_;
  const LocateSettings& settings_;
};

/// Radius around `centre_m` that holds 95 % of the shares.
double Radius95_m(const std::vector<Look>& looks, const std::vector<double>& probability,
                  const Eigen::Matrix3Xd& positions_m, const Eigen::Vector3d& centre_m) {
  std::vector<std::pair<double, double>> by_distance;
  for (size_t k = 0; k < looks.size(); ++k) {
    by_distance.emplace_back((positions_m.col(looks[k].place) - centre_m).norm(), probability[k]);
  }
  std::sort(by_distance.begin(), by_distance.end());
  double held = 0.0;
  for (const auto& [distance_m, share] : by_distance) {
    held += share;
    if (held >= 0.95) return distance_m;
  }
  return by_distance.back().first;
}

/// The mean place, and how far place and force may be from it and from the force there, which are
/// what is reported. Along that force the covariance has the spread of the sizes: places that face
/// another way have forces of which only a part lies along it.
void Summarise(const std::vector<Look>& looks, const std::vector<double>& probability,
               const CandidateLocations& places, const Eigen::Matrix3Xd& normals,
               ContactLocationPosterior* posterior) {
  const Eigen::Vector3d best_m = places.positions_m().col(posterior->place);
  double same = 0.0;
  for (size_t k = 0; k < looks.size(); ++k) {
    const Eigen::Vector3d place_m = places.positions_m().col(looks[k].place);
    if ((place_m - best_m).norm() > kSameLocation_m) continue;
    same += probability[k];
    posterior->mean_m += probability[k] * place_m;
  }
  posterior->mean_m /= same;
  const auto off_mean_m = [&](const Look& look) -> Eigen::Vector3d {
    return places.positions_m().col(look.place) - posterior->mean_m;
  };
  const auto force_N = [&](const Look& look) -> Eigen::Vector3d {
    return look.fit.tangential_N - look.fit.force_N * normals.col(look.place);
  };
  const Eigen::Vector3d there_N =
      force_N(*std::min_element(looks.begin(), looks.end(), [&](const Look& a, const Look& b) {
        return off_mean_m(a).squaredNorm() < off_mean_m(b).squaredNorm();
      }));
  double size_variance_N2 = 0.0;
  for (size_t k = 0; k < looks.size(); ++k) {
    const Eigen::Vector3d off_m = off_mean_m(looks[k]);
    const Eigen::Vector3d off_N = force_N(looks[k]) - there_N;
    const double larger_N = force_N(looks[k]).norm() - there_N.norm();
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
                                const LocateSettings& settings) {
  const Locator locator(problem, places, normals, usable, settings);
  const std::vector<Look> looks = locator.LookAround();
  if (looks.empty()) return {};
  const Look& best = Locator::Best(looks);
  if (!(best.fit.force_N > 0.0)) return {};
  const double freedom =
      std::max(1.0, static_cast<double>(problem.residual().size()) - settings.unknowns);
  const double left = problem.residual().squaredNorm() - best.fit.gain;
  const double noise_scale = kRowsAlike * std::max(1.0, left / freedom);
  std::vector<double> probability;
  for (const Look& look : looks) {
    const bool pushes = look.fit.force_N > 0.0;
    const double fall = look.fit.evidence - best.fit.evidence;
    const double before = best.unlikely - look.unlikely;
    probability.push_back(pushes ? look.share * std::exp(0.5 * (fall / noise_scale + before))
                                 : 0.0);
  }
  const double sum = std::accumulate(probability.begin(), probability.end(), 0.0);
  for (double& share : probability) share /= sum;

  ContactLocationPosterior posterior{.place = best.place, .fit = best.fit};
  Summarise(looks, probability, places, normals, &posterior);
  const double between_m2 = places.spacing_m() * places.spacing_m() / 12.0;
  posterior.covariance_m2 += between_m2 * Eigen::Matrix3d::Identity();
  posterior.ci95_m = std::max(
      Radius95_m(looks, probability, places.positions_m(), posterior.mean_m), places.spacing_m());
  return posterior;
}

}  // namespace palpate::force_estimation
