// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/contact_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "libs/core/index.hpp"
#include "libs/core/statistics.hpp"

namespace palpate::force_estimation {

namespace {

struct ContactSearchTuning {
  /// Candidates that are fitted to equilibrium. The first-order ranking errs among neighbours: more
  /// find the best one more often, at a fit each.
  int fitted_candidates = 3;
  /// Candidates whose fit is tried for these.
  size_t tried_candidates = 8;
  /// Coarse candidates around which fine places are screened, and how much worse than the best they
  /// may be: more find a narrow optimum beside a worse candidate.
  size_t refined_candidates = 6;
  double refined_score = 12.0;
  /// Contacts of the last frame are kept while the weighted residual is below this times that of
  /// the search. Larger: steadier locations and fewer searches. Smaller: a contact that moves is
  /// followed sooner.
  double keep_factor = 2.0;
  /// A force grown by this factor since the search knows its location that much better: it is
  /// searched again. Smaller: more searches while a force rises.
  double searched_again_growth = 2.0;
  /// Standard deviations of the forces by which they must have grown beyond that. Smaller: noise on
  /// weak forces starts searches of single frames, and averages begin again.
  double growth_sigmas = 3.0;
  /// Rounds of screening, each about the state that the round before found: responses to large
  /// forces are not linear.
  int most_rounds = 4;
  /// Continuation steps of a fit where no candidate is fitted without. Larger: forces farther from
  /// linear are found; each step costs a static solve.
  int continuation_steps = 8;
};
constexpr ContactSearchTuning kContactSearchTuning;

constexpr double kNever = std::numeric_limits<double>::infinity();

Status OnlyPullsExplain() {
  return {StatusCode::kUnobservable,
          "no contact that pushes explains the markers (adhesion: true allows one that pulls)"};
}

/// The configuration of `state` without its contact forces from `kept` on: no equilibrium.
ModelState WithoutFurtherForces(ModelState state, Eigen::Index kept) {
  state.balanced = false;
  state.lambda_f_N.conservativeResize(kept);
  return state;
}

double NoiseScale(double chi_squared, const RowTargets& targets, size_t contacts) {
  const int freedom = std::max(1, targets.rows - 3 * static_cast<int>(contacts));
  return std::max(1.0, chi_squared / freedom);
}

}  // namespace

ContactSearch::ContactSearch(robot::RobotModel& model, const Config& config, ForceNewton& fitter)
    : config_(config), fitter_(fitter), candidates_(model, config) {
  fitter_.KeepFactor(true);  // from frame to frame, and from the screening to the fits
}

const ContactSearch::Result& ContactSearch::Find(const RowTargets& targets,
                                                 const Eigen::VectorXd& shared_variance_m2,
                                                 const std::vector<robot::ActuatorCommand>& cables,
                                                 const fem::StaticState& free_state) {
  const double limit = ChiSquaredQuantile(1.0 - config_.significance, targets.rows);
  const ModelState start{.valid = true,
                         .balanced = true,
                         .x_m = free_state.x_m,
                         .lambda_a_N = free_state.multipliers_N,
                         .lambda_f_N = Eigen::VectorXd::Zero(0)};
  Eigen::VectorXd free_residual_m = Eigen::VectorXd::Zero(targets.value_m.size());
  const bool touched = fitter_.ChiSquared(targets, start, &free_residual_m) > limit;
  const bool kept = touched && KeepContacts(targets, cables, limit);
  if (!kept) {
    pool_.Clear();
    Search(targets, cables, start, nullptr, limit);
  }
  const Result& result = found_.result;
  if (!result.status.ok()) return result;
  const Eigen::VectorXd free_m = targets.value_m - free_residual_m;
  const bool due =
      pool_.Add({.targets = targets,
                 .shared_variance_m2 = shared_variance_m2,
                 .free_m = free_m,
                 .forces_N = result.state.lambda_f_N,
                 .covariance_N2 = result.fit.covariance_N2,
                 .noise_scale = NoiseScale(result.fit.chi_squared, targets, result.sites.size())});
  if (due) SearchInMean(targets, cables, start, limit);
  return result;
}

void ContactSearch::Search(const RowTargets& targets,
                           const std::vector<robot::ActuatorCommand>& cables,
                           const ModelState& start, const ModelState* about, double limit) {
  Result& result = found_.result;
  result = Result();
  result.status = Status(StatusCode::kNoContact, {});
  result.state = start;
  result.fit.residual_m = Eigen::VectorXd::Zero(targets.value_m.size());
  result.fit.chi_squared = fitter_.ChiSquared(targets, start, &result.fit.residual_m);
  for (int contact = 0; contact < config_.max_contacts; ++contact) {
    if (result.fit.chi_squared <= limit) break;
    if (targets.rows < 3 * (contact + 1)) {
      if (contact == 0) result.status = Status(StatusCode::kUnobservable, "too few markers");
      break;
    }
    Status added = AddContact(targets, cables, about);
    if (added.ok() || contact == 0) result.status = added;
    if (!added.ok()) break;  // the contacts before it hold
  }
  found_.chi_squared = result.fit.chi_squared;
  found_.force_N = result.state.lambda_f_N.norm();
  found_.location_covariance_N2 = result.location_covariance_N2;
}

/// The location is that of the mean, the forces are those of the frame. What the mean does not show
/// better stays. Responses are those about the frame's state, which is near: one about the free
/// state costs a round more.
void ContactSearch::SearchInMean(const RowTargets& targets,
                                 const std::vector<robot::ActuatorCommand>& cables,
                                 const ModelState& start, double limit) {
  const Found before = found_;
  Search(pool_.Mean(), cables, start, &before.result.state, limit);
  const bool same =
      found_.result.status.ok() && found_.result.sites.size() == before.result.sites.size();
  if (!same || !KeepContacts(targets, cables, kNever)) {
    found_ = before;
    return;
  }
  found_.chi_squared = found_.result.fit.chi_squared;
}

/// Fits the forces at the locations of the last frame. Model errors grow with the forces, and the
/// limit of the residual with them.
bool ContactSearch::KeepContacts(const RowTargets& targets,
                                 const std::vector<robot::ActuatorCommand>& cables,
                                 double noise_limit) {
  Result& result = found_.result;
  if (!result.status.ok() || result.sites.empty()) return false;
  fitter_.SetSites(result.fit_sites);
  ModelState state = result.state;
  state.balanced = false;
  // Where steps from the last frame diverge, a search costs less than continuation to a place that
  // may be wrong.
  fitter_.LimitContinuationSteps(0);
  const ForceFit& fit = fitter_.Fit(targets, cables, &state);
  fitter_.LimitContinuationSteps(kContactSearchTuning.continuation_steps);
  if (!fit.status.ok()) return false;
  const double growth = state.lambda_f_N.squaredNorm() / (found_.force_N * found_.force_N);
  const double searched =
      kContactSearchTuning.keep_factor * found_.chi_squared * std::max(1.0, growth);
  const double still_known_N =
      kContactSearchTuning.searched_again_growth * found_.force_N +
      kContactSearchTuning.growth_sigmas * std::sqrt(fit.covariance_N2.trace());
  if (fit.chi_squared > std::max(noise_limit, searched)) return false;
  if (state.lambda_f_N.norm() > still_known_N) return false;
  result.fit = fit;
  result.state = std::move(state);
  for (size_t s = 0; s < result.sites.size(); ++s) {
    result.location_covariance_N2[s] = growth * found_.location_covariance_N2[s];
  }
  return true;
}

bool ContactSearch::IsTaken(const FitSite& site) const {
  const double apart_m =
      std::max(config_.candidate_patch_radius_m, 0.5 * candidates_.fine_spacing_m());
  const auto& taken = found_.result.fit_sites;
  return std::any_of(taken.begin(), taken.end(), [&](const FitSite& other) {
    return (other.patch.centre_m - site.patch.centre_m).norm() < apart_m;
  });
}

Status ContactSearch::ScreenSites(const RowTargets& targets,
                                  const std::vector<robot::ActuatorCommand>& cables,
                                  const ModelState& state, const std::vector<FitSite>& sites,
                                  std::vector<Screened>* screened) {
  std::vector<ScreenedSite> results;
  if (Status status = fitter_.Screen(targets, cables, state, sites, &results); !status.ok()) {
    return status;
  }
  for (size_t k = 0; k < sites.size(); ++k) {
    if (IsTaken(sites[k])) continue;
    const double cost = candidates_.PriorCost(sites[k], results[k].force_N, state.x_m);
    screened->push_back({sites[k], results[k].force_N, results[k].chi_squared + cost});
  }
  std::stable_sort(screened->begin(), screened->end(),
                   [](const Screened& a, const Screened& b) { return a.score < b.score; });
  return Status::Ok();
}

/// The coarse candidates, and the fine places around the best of them; the best first. Responses
/// are those about `state`.
Status ContactSearch::ScreenAll(const RowTargets& targets,
                                const std::vector<robot::ActuatorCommand>& cables,
                                const ModelState& state, std::vector<Screened>* screened) {
  screened->clear();
  Status status = ScreenSites(targets, cables, state, candidates_.coarse(), screened);
  if (!status.ok()) return status;
  if (screened->empty() || !std::isfinite(screened->front().score)) {
    return OnlyPullsExplain();
  }
  const double least = screened->front().score;
  const double noise_scale = NoiseScale(least, targets, found_.result.sites.size() + 1);
  std::vector<Eigen::Vector3d> near_m;
  for (const Screened& candidate : *screened) {
    if (near_m.size() == kContactSearchTuning.refined_candidates) break;
    if (candidate.score > least + noise_scale * kContactSearchTuning.refined_score) break;
    near_m.push_back(candidate.site.patch.centre_m);
  }
  return ScreenSites(targets, cables, state, candidates_.FinePlaces(near_m), screened);
}

/// Fits one candidate to equilibrium, from `start` on: with the force of the screening, or with
/// none.
bool ContactSearch::FitCandidate(const RowTargets& targets,
                                 const std::vector<robot::ActuatorCommand>& cables,
                                 const ModelState& start, const Screened& candidate,
                                 FirstForce first_force, Fitted* fitted) {
  std::vector<FitSite> sites = found_.result.fit_sites;
  sites.push_back(candidate.site);
  fitter_.SetSites(sites);
  ModelState state = start;
  state.lambda_f_N.conservativeResizeLike(Eigen::VectorXd::Zero(3 * fitter_.SiteCount()));
  if (first_force == FirstForce::kScreened) {
    state.balanced = false;
    state.lambda_f_N.tail<3>() = candidate.force_N;
  }
  const ForceFit& fit = fitter_.Fit(targets, cables, &state);
  if (!fit.status.ok()) return false;
  const Eigen::Vector3d force_N = state.lambda_f_N.tail<3>();
  const double cost = candidates_.PriorCost(candidate.site, force_N, state.x_m);
  *fitted = {.site = candidate.site, .fit = fit, .state = state, .score = fit.chi_squared + cost};
  return true;
}

/// Of fits that all pull, the one nearest the data is the better state to screen about.
bool ContactSearch::IsBetter(const Fitted& a, const Fitted& b) {
  if (std::isfinite(a.score) || std::isfinite(b.score)) return a.score < b.score;
  return !b.fit.status.ok() || a.fit.chi_squared < b.fit.chi_squared;
}

/// Fits the best candidates, and takes the best of them into `best` where it is better. Those at
/// `fitted_m`, of the rounds before, are not fitted again.
bool ContactSearch::FitBest(const RowTargets& targets,
                            const std::vector<robot::ActuatorCommand>& cables,
                            const ModelState& start, const std::vector<Screened>& screened,
                            FirstForce first_force, std::vector<Eigen::Vector3d>* fitted_m,
                            Fitted* best) {
  bool better = false;
  int fitted = 0;
  const size_t tried = std::min(screened.size(), kContactSearchTuning.tried_candidates);
  for (size_t k = 0; k < tried && fitted < kContactSearchTuning.fitted_candidates; ++k) {
    if (!std::isfinite(screened[k].score)) break;
    const Eigen::Vector3d& place_m = screened[k].site.patch.centre_m;
    if (std::find(fitted_m->begin(), fitted_m->end(), place_m) != fitted_m->end()) {
      ++fitted;
      continue;
    }
    Fitted candidate;
    if (!FitCandidate(targets, cables, start, screened[k], first_force, &candidate)) continue;
    if (std::isfinite(candidate.score)) ++fitted;
    fitted_m->push_back(place_m);
    if (!IsBetter(candidate, *best)) continue;
    better = true;
    *best = std::move(candidate);
  }
  return better;
}

/// The first round screens about `known_state`, or where it is null about the state found so far.
Status ContactSearch::AddContact(const RowTargets& targets,
                                 const std::vector<robot::ActuatorCommand>& cables,
                                 const ModelState* known_state) {
  Result& result = found_.result;
  const Eigen::Index known_forces = result.state.lambda_f_N.size();
  std::vector<Screened> screened;
  std::vector<Eigen::Vector3d> fitted_m;
  Fitted best;
  ModelState about = result.state;
  if (known_state != nullptr) about = WithoutFurtherForces(*known_state, known_forces);
  for (int round = 0; round < kContactSearchTuning.most_rounds; ++round) {
    fitter_.SetSites(result.fit_sites);
    Status status = ScreenAll(targets, cables, about, &screened);
    if (!status.ok() && round == 0) return status;
    // A wrong candidate may diverge, and its continuation costs more than all others.
    fitter_.LimitContinuationSteps(0);
    bool better = status.ok() && FitBest(targets, cables, about, screened, FirstForce::kScreened,
                                         &fitted_m, &best);
    fitter_.LimitContinuationSteps(kContactSearchTuning.continuation_steps);
    if (round == 0 && !better) {
      better = FitBest(targets, cables, about, screened, FirstForce::kNone, &fitted_m, &best);
    }
    if (!better) break;
    about = WithoutFurtherForces(best.state, known_forces);
  }
  if (best.fit.status.ok() && !std::isfinite(best.score)) return OnlyPullsExplain();
  if (!best.fit.status.ok()) {
    return {StatusCode::kNotConverged, "no candidate contact leads to an equilibrium"};
  }
  result.fit = best.fit;
  result.state = best.state;
  result.fit_sites.push_back(best.site);
  result.sites.push_back({.name = "contact_" + std::to_string(result.sites.size() + 1),
                          .position_m = best.site.patch.centre_m,
                          .patch_radius_m = config_.candidate_patch_radius_m});
  AddUncertainty(screened, best, NoiseScale(best.score, targets, result.sites.size()));
  return Status::Ok();
}

/// Of the location and, from it, of the force.
void ContactSearch::AddUncertainty(const std::vector<Screened>& screened, const Fitted& best,
                                   double noise_scale) {
  Result& result = found_.result;
  const double least = std::min(screened.front().score, best.score);
  const Eigen::Vector3d force_N = best.state.lambda_f_N.tail<3>();
  const double limit = least + noise_scale * ChiSquaredQuantile(0.95, 2);
  const auto place_m = [&](const FitSite& site) {
    return site.patch.weights.Position(best.state.x_m);
  };
  double radius_m = 0.5 * candidates_.fine_spacing_m();
  double weights = std::exp(-0.5 * (best.score - least) / noise_scale);
  Eigen::Matrix3d covariance_N2 = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d covariance_m2 = Eigen::Matrix3d::Zero();
  for (const Screened& other : screened) {
    if (!std::isfinite(other.score)) break;
    if (other.score <= limit) {
      radius_m = std::max(radius_m, (other.site.patch.centre_m - best.site.patch.centre_m).norm());
    }
    const double weight = std::exp(-0.5 * (other.score - least) / noise_scale);
    const Eigen::Vector3d change_N = other.force_N - force_N;
    covariance_N2 += weight * change_N * change_N.transpose();
    const Eigen::Vector3d change_m = place_m(other.site) - place_m(best.site);
    covariance_m2 += weight * change_m * change_m.transpose();
    weights += weight;
  }
  result.location_ci95_m = std::max(result.location_ci95_m, radius_m);
  result.location_covariance_N2.push_back(covariance_N2 / weights);
  // Between two candidates any place is as probable.
  const Eigen::Vector3d normal = best.site.patch.normal;
  const double between_m2 = std::pow(candidates_.fine_spacing_m(), 2) / 12.0;
  result.location_covariance_m2.push_back(
      covariance_m2 / weights +
      between_m2 * (Eigen::Matrix3d::Identity() - normal * normal.transpose()));
}

}  // namespace palpate::force_estimation
