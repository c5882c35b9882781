// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/inference/fitter.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace palpate::diagnosis {

Fitter::Fitter(const ObservedExperiment& observed, const robot::RobotBody& body,
               const CauseBook& book, const NoiseModel& noise, int threads)
    : observed_(observed),
      book_(book),
      noise_(noise),
      nominal_(DraftOf(body, observed)),
      simulator_(observed, threads),
      marker_rest_m_(3, std::ssize(body.markers)),
      healthy_(book.BeliefWith({})) {
  for (std::size_t m = 0; m < body.markers.size(); ++m) {
    marker_rest_m_.col(static_cast<Eigen::Index>(m)) = body.markers[m].point.rest_m;
  }
}

void Fitter::LineariseAt(const Eigen::VectorXd& z, const std::vector<int>& columns,
                         const Simulation* start, Fit* fit) const {
  const CauseList causes = book_.ListOf(columns);
  const std::vector<Eigen::Index> parameters = book_.ParametersOf(columns);
  const Eigen::VectorXd z_of_columns = z(parameters);
  const ModelDraft draft = DraftWith(nominal_, causes, z_of_columns);
  fit->z = z;
  fit->simulation = simulator_.Run(draft, start);
  simulator_.Differentiate(draft, causes, z_of_columns, nominal_, &fit->simulation);
  for (SimulatedSample& sample : fit->simulation.samples) {
    const auto s = static_cast<std::size_t>(&sample - fit->simulation.samples.data());
    Eigen::MatrixXd all_m = start != nullptr
                                ? start->samples[s].jacobian_m
                                : Eigen::MatrixXd::Zero(sample.jacobian_m.rows(), z.size());
    all_m(Eigen::all, parameters) = sample.jacobian_m;
    sample.jacobian_m = std::move(all_m);
  }
  fit->model = Linearise(observed_, fit->simulation, z, marker_rest_m_, noise_);
  fit->status = fit->simulation.status;
}

Posterior Fitter::Guess(const Fit& about, const std::vector<int>& faults) const {
  return book_.InferWithin(about.model.All(), faults);
}

Fit Fitter::AsBuilt() const {
  Fit fit;
  std::vector<int> all(static_cast<std::size_t>(book_.size()));
  std::iota(all.begin(), all.end(), 0);
  LineariseAt(Eigen::VectorXd::Zero(book_.parameter_count()), all, nullptr, &fit);
  fit.posterior = Guess(fit, {});
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

Fit Fitter::Refine(const std::vector<int>& faults, const Fit& start) const {
  constexpr int kMostRounds = 4;
  constexpr double kNothing = 0.5;  // of ln evidence
  const std::vector<int> believed = book_.ActiveIn(book_.BeliefWith(faults));
  Fit fit;
  fit.faults = faults;
  fit.posterior = Guess(start, faults);
  const Simulation* from = &start.simulation;
  for (int round = 0; round < kMostRounds; ++round) {
    const double before = fit.posterior.ln_evidence;
    Fit next;
    next.faults = faults;
    LineariseAt(PointOf(fit.posterior, faults), believed, from, &next);
    next.posterior = Guess(next, faults);
    fit = std::move(next);
    from = &fit.simulation;
    const bool settled = std::abs(fit.posterior.ln_evidence - before) < kNothing;
    if (!fit.status.ok() || settled || IsNear(fit)) break;
  }
  return fit;
}

}  // namespace palpate::diagnosis
