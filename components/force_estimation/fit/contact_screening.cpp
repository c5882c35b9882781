// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <limits>

#include "components/force_estimation/fit/force_fitter.hpp"

namespace palpate::force_estimation {

/// One candidate after the other over the same factor: three more columns each.
Status ForceFitter::Screen(const RowTargets& targets,
                           const std::vector<robot::CableCommand>& cables, const ModelState& state,
                           const std::vector<FitSite>& candidates,
                           std::vector<double>* chi_squared) {
  const std::vector<FitSite> sites = sites_;
  ModelState extended = state;
  chi_squared->clear();
  UpdateWeight();
  Status status = Status::Ok();
  for (size_t c = 0; c < candidates.size() && status.ok(); ++c) {
    std::vector<FitSite> with_candidate = sites;
    with_candidate.push_back(candidates[c]);
    SetSites(with_candidate);
    extended.lambda_f_N.setZero(3 * SiteCount());
    extended.lambda_f_N.head(state.lambda_f_N.size()) = state.lambda_f_N;
    elimination_.Start(cables, state.lambda_a_N);
    if (c == 0) {
      status = Linearise(extended, /*allow_shift=*/true);
    } else {
      compliance_.Compute(state.x_m, model_.cable_rest_length_m(), state.lambda_a_N,
                          extended.lambda_f_N);
    }
    if (status.ok()) status = elimination_.Eliminate(compliance_, cables);
    if (!status.ok()) break;
    if (!SolveQp(targets, cables, extended).ok()) {
      chi_squared->push_back(std::numeric_limits<double>::infinity());
      continue;
    }
    const Eigen::VectorXd residual =
        targets.value_m - elimination_.e0_m() - elimination_.G() * new_lambda_f_;
    chi_squared->push_back((residual.array().square() * targets.weight.array()).sum());
  }
  SetSites(sites);
  return status;
}

}  // namespace palpate::force_estimation
