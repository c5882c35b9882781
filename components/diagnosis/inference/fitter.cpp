// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/inference/fitter.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace palpate::diagnosis {

Fitter::Fitter(const ObservedExperiment& observed, const robot::RobotBody& body,
               const CauseBook& book, const NoiseModel& noise, int threads)
    : observed_(observed),
      book_(book),
      causes_(book.All()),
      noise_(noise),
      nominal_(DraftOf(body, observed)),
      simulator_(observed, threads),
      marker_rest_m_(3, std::ssize(body.markers)),
      healthy_(book.BeliefWith({})) {
  for (std::size_t m = 0; m < body.markers.size(); ++m) {
    marker_rest_m_.col(static_cast<Eigen::Index>(m)) = body.markers[m].point.rest_m;
  }
}

/// What the `wanted` causes do at fit->z; of the rest what they do in `others`.
void Fitter::Differentiate(const std::vector<bool>& wanted, const Simulation* others,
                           Fit* fit) const {
  const ModelDraft draft = DraftWith(nominal_, causes_, fit->z);
  Simulation& simulation = fit->simulation;
  simulator_.Differentiate(draft, causes_, fit->z, wanted, nominal_, &simulation);
  for (std::size_t s = 0; s < simulation.samples.size() && others != nullptr; ++s) {
    for (int k = 0; k < book_.size(); ++k) {
      if (wanted[static_cast<std::size_t>(k)]) continue;
      simulation.samples[s].jacobian_m.middleCols(book_.first(k), book_.count(k)) =
          others->samples[s].jacobian_m.middleCols(book_.first(k), book_.count(k));
    }
  }
  fit->model = Linearise(observed_, simulation, fit->z, marker_rest_m_, noise_);
  fit->posterior = Guess(*fit, fit->faults);
}

Posterior Fitter::Guess(const Fit& about, const std::vector<int>& faults) const {
  return book_.InferWithin(about.model.All(), faults);
}

Fit Fitter::AsBuilt(const Simulation* simulated) const {
  Fit fit;
  fit.z = Eigen::VectorXd::Zero(book_.parameter_count());
  fit.simulation = simulated != nullptr ? *simulated : simulator_.Run(nominal_);
  fit.status = fit.simulation.status;
  return Complete(std::move(fit));
}

Fit Fitter::Complete(Fit fit) const {
  if (fit.complete) return fit;
  Differentiate(std::vector<bool>(causes_.size(), true), nullptr, &fit);
  fit.complete = true;
  return fit;
}

Eigen::VectorXd Fitter::PointOf(const Posterior& posterior, const std::vector<int>& faults) const {
  Eigen::VectorXd z = posterior.mean;
  for (int k = 0; k < book_.size(); ++k) {
    const bool fault = std::find(faults.begin(), faults.end(), k) != faults.end();
    for (Eigen::Index p = 0; p < book_.count(k) && !fault; ++p) {
      const bool one_sided = book_.cause(k).parameters()[static_cast<std::size_t>(p)].least == 0.0;
      if (one_sided) z[book_.first(k) + p] = 0.0;
    }
  }
  return z;
}

bool Fitter::IsNear(const Fit& fit) const {
  constexpr double kOfFault = 0.5;  // of what it is known to
  constexpr double kOfTolerance = 1.5;
  const Belief belief = book_.BeliefWith(fit.faults);
  const Eigen::VectorXd step = PointOf(fit.posterior, fit.faults) - fit.z;
  for (Eigen::Index p = 0; p < step.size(); ++p) {
    const double known = std::sqrt(fit.posterior.covariance(p, p));
    const bool fault = belief.sigma[p] != healthy_.sigma[p];
    const double reach = fault ? kOfFault * known : kOfTolerance * belief.sigma[p];
    if (std::abs(step[p]) > reach) return false;
  }
  return true;
}

/// Chi-squared of data and belief where the fit's simulation is.
double Fitter::MisfitAt(const Fit& fit) const {
  const Information data = fit.model.All();
  const Belief belief = book_.BeliefWith(fit.faults);
  double misfit = data.c + fit.z.dot(data.H * fit.z - 2.0 * data.b);
  for (Eigen::Index p = 0; p < fit.z.size(); ++p) {
    if (belief.sigma[p] == 0.0) continue;
    misfit += std::pow((fit.z[p] - belief.mean[p]) / belief.sigma[p], 2);
  }
  return misfit;
}

Fit Fitter::Refine(const std::vector<int>& faults, const Fit& start) const {
  constexpr int kMostRounds = 4;
  constexpr int kMostRoundsOverKinks = 10;
  const bool has_kinks = std::any_of(faults.begin(), faults.end(),
                                     [&](int k) { return book_.cause(k).Start().has_value(); });
  return Refine(faults, start, has_kinks ? kMostRoundsOverKinks : kMostRounds);
}

Fit Fitter::Refine(const std::vector<int>& faults, const Fit& start, int most_rounds) const {
  constexpr double kNothing = 0.5;  // of ln evidence
  constexpr double kWorse = 1.0;    // of chi-squared
  std::vector<bool> wanted(causes_.size(), false);
  for (const int fault : faults) wanted[static_cast<std::size_t>(fault)] = true;
  Fit fit;
  fit.posterior = Guess(start, faults);
  const Simulation* from = &start.simulation;
  Eigen::VectorXd to = PointOf(fit.posterior, faults);
  double misfit = std::numeric_limits<double>::infinity();
  for (int round = 0; round < most_rounds; ++round) {
    const double before = fit.posterior.ln_evidence;
    Fit next;
    next.faults = faults;
    next.z = to;
    next.simulation = simulator_.Run(DraftWith(nominal_, causes_, next.z), from);
    next.status = next.simulation.status;
    Differentiate(wanted, from, &next);
    const double now = MisfitAt(next);
    if (round > 0 && (!next.status.ok() || now > misfit + kWorse)) {
      to = 0.5 * (fit.z + to);
      continue;
    }
    misfit = now;
    fit = std::move(next);
    from = &fit.simulation;
    to = PointOf(fit.posterior, faults);
    const bool settled = std::abs(fit.posterior.ln_evidence - before) < kNothing;
    if (!fit.status.ok() || settled || IsNear(fit)) break;
  }
  return fit;
}

}  // namespace palpate::diagnosis
