// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/inference/hypothesis_set.hpp"

#include <algorithm>
#include <cmath>

#include "components/diagnosis/inference/group_scale.hpp"
#include "libs/core/index.hpp"

namespace palpate::diagnosis {

namespace {

/// Of the first parameter, or of the length of the vector that it is a component of.
double FirstTolerance(const std::vector<FaultParameter>& parameters) {
  const auto components = static_cast<double>(
      std::count_if(parameters.begin(), parameters.end(),
                    [](const FaultParameter& parameter) { return parameter.component; }));
  const FaultParameter& first = parameters.front();
  return first.component ? std::sqrt(components) * first.tolerance : first.tolerance;
}

/// Of one parameter, where that of the first is given.
double GivenTolerance(const std::vector<FaultParameter>& parameters, std::size_t p,
                      double given_of_first) {
  const double first = FirstTolerance(parameters);
  if (first > 0.0) return parameters[p].tolerance * given_of_first / first;
  return p == 0 ? given_of_first : parameters[p].tolerance;
}

}  // namespace

HypothesisSet::HypothesisSet(std::vector<FaultModelPtr> models,
                             const std::map<std::string, double>& tolerances)
    : models_(std::move(models)), first_{0} {
  for (const FaultModelPtr& fault : models_) {
    const std::vector<FaultParameter>& parameters = fault->parameters();
    first_.push_back(first_.back() + std::ssize(parameters));
    const auto given = tolerances.find(fault->name().id);
    for (std::size_t p = 0; p < parameters.size(); ++p) {
      group_of_.push_back(static_cast<int>(parameters[p].group));
      tolerance_.push_back(given == tolerances.end()
                               ? parameters[p].tolerance
                               : GivenTolerance(parameters, p, given->second));
    }
  }
}

bool HypothesisSet::CanBeFault(int k) const {
  const auto& parameters = model(k).parameters();
  return std::any_of(parameters.begin(), parameters.end(), [](const FaultParameter& parameter) {
    return parameter.fault > parameter.tolerance;
  });
}

GaussianPrior HypothesisSet::PriorWith(const std::vector<int>& faults) const {
  GaussianPrior prior(parameter_count());
  for (int k = 0; k < size(); ++k) {
    const bool fault = std::find(faults.begin(), faults.end(), k) != faults.end();
    for (Eigen::Index p = 0; p < count(k); ++p) {
      const FaultParameter& parameter = model(k).parameters()[At(p)];
      const double tolerance = ToleranceOf(k, static_cast<int>(p));
      prior.sigma[first(k) + p] = fault ? std::max(parameter.fault, tolerance) : tolerance;
      if (fault) prior.mean[first(k) + p] = parameter.fault_at;
    }
  }
  return prior;
}

GaussianPrior HypothesisSet::PriorWith(const std::vector<int>& faults,
                                       const Eigen::VectorXd& scale) const {
  GaussianPrior prior = PriorWith(faults);
  for (Eigen::Index p = 0; p < prior.sigma.size(); ++p) {
    if (group_of_[At(p)] >= 0) prior.sigma[p] *= scale[group_of_[At(p)]];
  }
  return prior;
}

Eigen::VectorXd HypothesisSet::InferScale(const Information& data, const std::vector<int>& faults,
                                          const Eigen::VectorXd& start) const {
  GaussianPrior prior = PriorWith(faults);
  for (const Eigen::Index p : Idle(faults)) prior.mean[p] = data.about[p];
  return InferGroupScale(data, prior, group_of_, kDiscrepancyGroups, start);
}

Eigen::VectorXd HypothesisSet::Simulated(Eigen::VectorXd z) const {
  for (int k = 0; k < size(); ++k) {
    if (model(k).AddsToPrediction()) z.segment(first(k), count(k)).setZero();
  }
  return z;
}

Posterior HypothesisSet::InferWithin(const Information& data, const std::vector<int>& faults,
                                     const Eigen::VectorXd& scale,
                                     const std::vector<Eigen::Index>& at_zero) const {
  const Eigen::VectorXd known = scale.size() > 0 ? scale : InferScale(data, faults);
  GaussianPrior prior = PriorWith(faults, known);
  prior.sigma(at_zero).setZero();
  for (const Eigen::Index p : Idle(faults)) prior.mean[p] = data.about[p];
  while (true) {
    Posterior posterior = Infer(data, prior);
    posterior.scale = known;
    bool inside = true;
    for (const int k : faults) {
      for (Eigen::Index p = 0; p < count(k); ++p) {
        const FaultParameter& parameter = model(k).parameters()[At(p)];
        const Eigen::Index column = first(k) + p;
        const double z = posterior.mean[column];
        const double bounded = std::clamp(z, parameter.least, parameter.most);
        if (bounded == z || prior.sigma[column] == 0.0) continue;
        prior.mean[column] = bounded;
        prior.sigma[column] = 0.0;
        inside = false;
      }
    }
    posterior.prior = prior;
    if (inside) return posterior;
  }
}

std::vector<Eigen::Index> HypothesisSet::Idle(const std::vector<int>& faults) const {
  std::vector<Eigen::Index> idle;
  for (int k = 0; k < size(); ++k) {
    if (std::find(faults.begin(), faults.end(), k) != faults.end()) continue;
    for (Eigen::Index p = 0; p < count(k); ++p) {
      const bool qualifies = model(k).parameters()[At(p)].qualifies;
      if (qualifies && ToleranceOf(k, static_cast<int>(p)) == 0.0) idle.push_back(first(k) + p);
    }
  }
  return idle;
}

FaultModelList HypothesisSet::All() const {
  FaultModelList list;
  for (const FaultModelPtr& fault : models_) list.push_back(fault.get());
  return list;
}

std::vector<Eigen::Index> HypothesisSet::ParametersOf(const std::vector<int>& numbers) const {
  std::vector<Eigen::Index> parameters;
  for (const int k : numbers) {
    for (Eigen::Index p = 0; p < count(k); ++p) parameters.push_back(first(k) + p);
  }
  return parameters;
}

}  // namespace palpate::diagnosis
