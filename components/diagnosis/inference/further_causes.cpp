// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/inference/further_causes.hpp"

#include <algorithm>
#include <cmath>

#include "components/diagnosis/inference/screening.hpp"

namespace palpate::diagnosis {

std::vector<FurtherCause> FurtherCauses(const Fitter& fitter, const Fit& fit) {
  constexpr double kOfWeight = 0.02;
  const std::vector<Candidate> candidates = Screen(fitter, fit, fit.faults);
  const double share = 1.0 / static_cast<double>(std::max<std::size_t>(1, candidates.size()));
  std::vector<FurtherCause> further;
  for (const Candidate& candidate : candidates) {
    // A linear model that says more was not borne out, or it would have been named.
    const double weight = std::min(1.0, share * std::exp(candidate.ln_bayes_factor));
    if (weight < kOfWeight) continue;
    further.push_back({.cause = candidate.cause,
                       .weight = weight,
                       .posterior = fitter.Guess(fit, With(fit.faults, candidate.cause))});
  }
  return further;
}

Eigen::MatrixXd CovarianceBeside(const HypothesisSet& hypotheses, const Fit& fit, int cause,
                                 const std::vector<FurtherCause>& further,
                                 const Eigen::MatrixXd& without) {
  const Eigen::Index first = hypotheses.first(cause);
  const Eigen::Index count = hypotheses.count(cause);
  Eigen::MatrixXd sum = without;
  double weights = 1.0;
  for (const FurtherCause& other : further) {
    const Eigen::VectorXd off =
        other.posterior.mean.segment(first, count) - fit.posterior.mean.segment(first, count);
    sum += other.weight *
           (other.posterior.covariance.block(first, first, count, count) + off * off.transpose());
    weights += other.weight;
  }
  return sum / weights;
}

}  // namespace palpate::diagnosis
