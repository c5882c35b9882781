// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/inference/fitter.hpp"

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
      marker_rest_m_(3, std::ssize(body.markers)) {
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
    Eigen::MatrixXd all_m = Eigen::MatrixXd::Zero(sample.jacobian_m.rows(), z.size());
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
  std::vector<int> all(static_cast<std::size_t>(book_.size()));
  std::iota(all.begin(), all.end(), 0);
  Fit fit;
  LineariseAt(Eigen::VectorXd::Zero(book_.parameter_count()), all, nullptr, &fit);
  fit.posterior = Guess(fit, {});
  return fit;
}

Fit Fitter::Refine(const std::vector<int>& faults, const Fit& start, Columns columns) const {
  constexpr int kMostRounds = 4;
  constexpr double kNothing = 0.3;  // of ln evidence
  std::vector<int> believed = book_.ActiveIn(book_.BeliefWith(faults));
  std::vector<int> all(static_cast<std::size_t>(book_.size()));
  std::iota(all.begin(), all.end(), 0);
  Fit fit;
  fit.faults = faults;
  fit.posterior = Guess(start, faults);
  const Simulation* from = &start.simulation;
  for (int round = 0; round < kMostRounds; ++round) {
    Fit next;
    next.faults = faults;
    LineariseAt(fit.posterior.mean, columns == Columns::kAll ? all : believed, from, &next);
    next.posterior = Guess(next, faults);
    const double gain = next.posterior.ln_evidence - fit.posterior.ln_evidence;
    fit = std::move(next);
    from = &fit.simulation;
    if (std::abs(gain) < kNothing) break;
  }
  return fit;
}

}  // namespace palpate::diagnosis
