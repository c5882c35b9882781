// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/inference/model_averaging.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "components/diagnosis/inference/forward_selection.hpp"
#include "libs/core/index.hpp"

namespace palpate::diagnosis {

namespace {

/// More moves find better places; a smaller weight widens intervals by less probable faults.
struct AveragingTuning {
  int most_moves = 2;           ///< to another place of a fault
  double clearly_better = 2.0;  ///< ln evidence that a place must gain
  double least_weight = 0.02;   ///< of a further fault that widens intervals
};
constexpr AveragingTuning kAveragingTuning;

/// What a linear model says of the fault at another of its places.
struct Elsewhere {
  int fault = -1;
  Posterior posterior;
};

std::vector<int> Moved(std::vector<int> faults, int from, int to) {
  std::replace(faults.begin(), faults.end(), from, to);
  return faults;
}

std::vector<Elsewhere> FitElsewhere(const Fitter& fitter, const Fit& fit, int fault) {
  const HypothesisSet& hypotheses = fitter.hypotheses();
  std::vector<Elsewhere> places;
  const Information& data = fit.model.All();
  for (int k = 0; k < hypotheses.size(); ++k) {
    if (k == fault || !(hypotheses.model(k).name() == hypotheses.model(fault).name())) continue;
    places.push_back({k, hypotheses.InferWithin(data, Moved(fit.faults, fault, k))});
  }
  return places;
}

/// z of the one's parameters [parameters], counted from where the other's count.
Eigen::VectorXd CountedFrom(const FaultModel& other, const FaultModel& one, Eigen::VectorXd z) {
  for (std::size_t p = 0; p < one.parameters().size(); ++p) {
    const FaultParameter& from = one.parameters()[p];
    const FaultParameter& to = other.parameters()[p];
    if (from.nominal == to.nominal) continue;
    z[ToIndex(p)] += from.scale == FaultParameter::Scale::kFactor
                         ? std::log(from.nominal / to.nominal)
                         : from.nominal - to.nominal;
  }
  return z;
}

}  // namespace

Fit AtTheBestPlace(const Fitter& fitter, Fit fit, int* fault) {
  if (fitter.hypotheses().model(*fault).Start().has_value()) return fit;  // all were tried
  for (int move = 0; move < kAveragingTuning.most_moves && fit.status.ok() && !fitter.IsOutOfTime();
       ++move) {
    const std::vector<Elsewhere> places = FitElsewhere(fitter, fit, *fault);
    const auto best =
        std::max_element(places.begin(), places.end(), [](const auto& a, const auto& b) {
          return a.posterior.ln_evidence < b.posterior.ln_evidence;
        });
    const double least = fit.posterior.ln_evidence + kAveragingTuning.clearly_better;
    if (best == places.end() || best->posterior.ln_evidence < least) break;
    Fit there = fitter.Complete(fitter.Refine(Moved(fit.faults, *fault, best->fault), fit));
    if (!there.status.ok() || there.posterior.ln_evidence < least) break;
    *fault = best->fault;
    fit = std::move(there);
  }
  return fit;
}

Eigen::MatrixXd CovarianceOverPlaces(const Fitter& fitter, const Fit& fit, int fault) {
  const HypothesisSet& hypotheses = fitter.hypotheses();
  const Eigen::Index first = hypotheses.first(fault);
  const Eigen::Index count = hypotheses.count(fault);
  Eigen::MatrixXd sum = fit.posterior.covariance.block(first, first, count, count);
  if (hypotheses.model(fault).Start().has_value()) return sum;
  const Eigen::VectorXd mean = fit.posterior.mean.segment(first, count);
  double weights = 1.0;
  for (const auto& [k, posterior] : FitElsewhere(fitter, fit, fault)) {
    // No more than the fit's own: what promised more did not keep it.
    const double weight =
        std::exp(std::min(0.0, posterior.ln_evidence - fit.posterior.ln_evidence));
    const Eigen::VectorXd off = CountedFrom(hypotheses.model(fault), hypotheses.model(k),
                                            posterior.mean.segment(hypotheses.first(k), count)) -
                                mean;
    sum += weight *
           (posterior.covariance.block(hypotheses.first(k), hypotheses.first(k), count, count) +
            off * off.transpose());
    weights += weight;
  }
  return sum / weights;
}

std::vector<FurtherFault> FurtherFaults(const Fitter& fitter, const Fit& fit) {
  const std::vector<Candidate> candidates = Screen(fitter, fit, fit.faults);
  const double share = 1.0 / static_cast<double>(std::max<std::size_t>(1, candidates.size()));
  std::vector<FurtherFault> further;
  for (const Candidate& candidate : candidates) {
    // A linear model that says more was not borne out, or it would have been named.
    const double weight = std::min(1.0, share * std::exp(candidate.ln_bayes_factor));
    if (weight < kAveragingTuning.least_weight) continue;
    further.push_back(
        {.fault = candidate.fault,
         .weight = weight,
         .posterior = fitter.LinearPosterior(fit, With(fit.faults, candidate.fault))});
  }
  return further;
}

Eigen::MatrixXd CovarianceOverFurtherFaults(const HypothesisSet& hypotheses, const Fit& fit,
                                            int fault, const std::vector<FurtherFault>& further,
                                            const Eigen::MatrixXd& without) {
  const Eigen::Index first = hypotheses.first(fault);
  const Eigen::Index count = hypotheses.count(fault);
  Eigen::MatrixXd sum = without;
  double weights = 1.0;
  for (const FurtherFault& other : further) {
    const Eigen::VectorXd off =
        other.posterior.mean.segment(first, count) - fit.posterior.mean.segment(first, count);
    sum += other.weight *
           (other.posterior.covariance.block(first, first, count, count) + off * off.transpose());
    weights += other.weight;
  }
  return sum / weights;
}

}  // namespace palpate::diagnosis
