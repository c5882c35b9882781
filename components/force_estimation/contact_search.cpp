// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/contact_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "libs/core/error.hpp"
#include "libs/core/statistics.hpp"

namespace palpate::force_estimation {

namespace {

struct ContactSearchTuning {
  /// Candidates that are fitted to equilibrium. The first-order ranking errs among neighbours: more
  /// find the best one more often, at a fit each.
  size_t fitted_candidates = 3;
  /// Contacts of the last frame are kept while the weighted residual is below this times that of
  /// the search. Larger: steadier locations and fewer searches. Smaller: a contact that moves is
  /// followed sooner.
  double keep_factor = 2.0;
};
constexpr ContactSearchTuning kContactSearchTuning;

double MeanSpacing(const std::vector<FitSite>& candidates) {
  double sum = 0.0;
  for (size_t a = 0; a < candidates.size(); ++a) {
    double nearest = std::numeric_limits<double>::infinity();
    for (size_t b = 0; b < candidates.size(); ++b) {
      if (a == b) continue;
      nearest =
          std::min(nearest, (candidates[a].patch.centre_m - candidates[b].patch.centre_m).norm());
    }
    if (candidates.size() > 1) sum += nearest / static_cast<double>(candidates.size());
  }
  return sum;
}

std::vector<size_t> Ranking(const std::vector<double>& chi_squared) {
  std::vector<size_t> order(chi_squared.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t a, size_t b) { return chi_squared[a] < chi_squared[b]; });
  order.resize(std::min(order.size(), kContactSearchTuning.fitted_candidates));
  return order;
}

}  // namespace

ContactSearch::ContactSearch(robot::RobotModel& model, const Config& config, ForceFitter& fitter)
    : config_(config), fitter_(fitter) {
  for (const fem::BodyPoint& point : model.body().feature_points) {
    candidates_.push_back({.patch = model.Patch(point.rest_m, config.candidate_patch_radius_m)});
  }
  if (candidates_.empty()) throw InputError("the robot file gives no feature points to search");
  spacing_m_ = MeanSpacing(candidates_);
}

const ContactSearch::Result& ContactSearch::Find(const RowTargets& targets,
                                                 const std::vector<robot::CableCommand>& cables,
                                                 const fem::StaticState& free_state) {
  const double limit = ChiSquaredQuantile(1.0 - config_.significance, targets.rows);
  ModelState start{.valid = true,
                   .balanced = true,
                   .x_m = free_state.x_m,
                   .lambda_a_N = free_state.multipliers_N,
                   .lambda_f_N = Eigen::VectorXd::Zero(0)};
  ForceFit untouched;
  untouched.residual_m = Eigen::VectorXd::Zero(targets.value_m.size());
  untouched.chi_squared = fitter_.ChiSquared(targets, start, &untouched.residual_m);
  if (untouched.chi_squared > limit && KeepContacts(targets, cables, limit)) return result_;

  chosen_.clear();
  result_ = {.status = Status(StatusCode::kNoContact, {}),
             .fit = std::move(untouched),
             .state = std::move(start),
             .sites = {},
             .fit_sites = {},
             .location_ci95_m = 0.0};
  for (int contact = 0; contact < config_.max_contacts; ++contact) {
    if (result_.fit.chi_squared <= limit) break;
    if (targets.rows < 3 * (contact + 1)) {
      if (contact == 0) result_.status = Status(StatusCode::kUnobservable, "too few markers");
      break;
    }
    Status added = AddContact(targets, cables);
    if (added.ok() || contact == 0) result_.status = added;
    if (!added.ok()) break;  // the contacts before it hold
  }
  searched_chi_squared_ = result_.fit.chi_squared;
  searched_force_N_ = result_.state.lambda_f_N.norm();
  return result_;
}

/// Fits the forces at the locations of the last frame. Model errors grow with the forces, and the
/// limit of the residual with them.
bool ContactSearch::KeepContacts(const RowTargets& targets,
                                 const std::vector<robot::CableCommand>& cables,
                                 double noise_limit) {
  if (!result_.status.ok() || result_.sites.empty()) return false;
  fitter_.SetSites(result_.fit_sites);
  ModelState state = result_.state;
  state.balanced = false;
  const ForceFit& fit = fitter_.Fit(targets, cables, &state);
  if (!fit.status.ok()) return false;
  const double growth = state.lambda_f_N.squaredNorm() / (searched_force_N_ * searched_force_N_);
  const double searched =
      kContactSearchTuning.keep_factor * searched_chi_squared_ * std::max(1.0, growth);
  if (fit.chi_squared > std::max(noise_limit, searched)) return false;
  result_.fit = fit;
  result_.state = std::move(state);
  return true;
}

Status ContactSearch::AddContact(const RowTargets& targets,
                                 const std::vector<robot::CableCommand>& cables) {
  fitter_.SetSites(result_.fit_sites);
  std::vector<double> chi_squared;
  Status status = fitter_.Screen(targets, cables, result_.state, candidates_, &chi_squared);
  if (!status.ok()) return status;
  for (const size_t taken : chosen_) {
    chi_squared[taken] = std::numeric_limits<double>::infinity();
  }
  const ModelState start = result_.state;
  const std::vector<FitSite> known = result_.fit_sites;
  double best_chi_squared = std::numeric_limits<double>::infinity();
  size_t best = 0;
  for (const size_t candidate : Ranking(chi_squared)) {
    if (!std::isfinite(chi_squared[candidate])) break;
    std::vector<FitSite> sites = known;
    sites.push_back(candidates_[candidate]);
    fitter_.SetSites(sites);
    ModelState state = start;
    state.lambda_f_N.conservativeResizeLike(Eigen::VectorXd::Zero(3 * fitter_.SiteCount()));
    const ForceFit& fit = fitter_.Fit(targets, cables, &state);
    if (!fit.status.ok() || fit.chi_squared >= best_chi_squared) continue;
    best_chi_squared = fit.chi_squared;
    best = candidate;
    result_.fit = fit;
    result_.state = state;
    result_.fit_sites = sites;
  }
  if (!std::isfinite(best_chi_squared)) {
    return {StatusCode::kNotConverged, "no candidate contact leads to an equilibrium"};
  }
  chosen_.push_back(best);
  result_.sites.push_back({.name = "contact_" + std::to_string(known.size() + 1),
                           .position_m = candidates_[best].patch.centre_m,
                           .patch_radius_m = config_.candidate_patch_radius_m});
  const int freedom = std::max(1, targets.rows - 3 * static_cast<int>(result_.sites.size()));
  const double noise_scale = std::max(1.0, best_chi_squared / freedom);
  result_.location_ci95_m =
      std::max(result_.location_ci95_m, LocationInterval(chi_squared, best, noise_scale));
  return Status::Ok();
}

double ContactSearch::LocationInterval(const std::vector<double>& chi_squared, size_t best,
                                       double noise_scale) const {
  const double limit = *std::min_element(chi_squared.begin(), chi_squared.end()) +
                       noise_scale * ChiSquaredQuantile(0.95, 2);
  double radius = 0.5 * spacing_m_;
  for (size_t c = 0; c < candidates_.size(); ++c) {
    if (chi_squared[c] > limit) continue;
    radius =
        std::max(radius, (candidates_[c].patch.centre_m - candidates_[best].patch.centre_m).norm());
  }
  return radius;
}

}  // namespace palpate::force_estimation
