// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <map>
#include <string>
#include <vector>

#include "components/diagnosis/forward/fault_model.hpp"
#include "components/diagnosis/inference/evidence.hpp"
#include "libs/core/index.hpp"

namespace palpate::diagnosis {

/// The fault models of a robot, nuisance models included: their columns among all parameters, and
/// the prior of each hypothesis. A hypothesis is a list of fault models by number.
class HypothesisSet {
 public:
  /// `tolerances` (experiment.yaml): fault id -> sigma of its first parameter for a nominal robot,
  /// or of the length of the vector that this is a component of, the others in proportion. Other
  /// ids have no effect.
  HypothesisSet(std::vector<FaultModelPtr> models, const std::map<std::string, double>& tolerances);

  int size() const { return static_cast<int>(models_.size()); }
  const FaultModel& model(int k) const { return *models_[At(k)]; }
  Eigen::Index parameter_count() const { return first_.back(); }
  Eigen::Index first(int k) const { return first_[At(k)]; }
  Eigen::Index count(int k) const { return first(k + 1) - first(k); }
  double ToleranceOf(int k, int parameter) const { return tolerance_[At(first(k) + parameter)]; }

  /// Whether the one is a special case of the other (FaultModel::SpecialCase).
  bool IsSpecialCase(int special, int of) const {
    return model(of).SpecialCase() == model(special).name().id;
  }
  /// Whether its prior as a fault is wider than its tolerance; false of nuisance models.
  bool CanBeFault(int k) const;
  /// Prior of the hypothesis `faults`: these with their fault range, all others with tolerances,
  /// those of groups times their `scale` [groups] (Posterior::scale).
  GaussianPrior PriorWith(const std::vector<int>& faults, const Eigen::VectorXd& scale) const;
  /// The same in units of the groups' scales.
  GaussianPrior PriorWith(const std::vector<int>& faults) const;
  /// Deviations of the groups: the most probable under the hypothesis `faults`.
  Eigen::VectorXd InferScale(const Information& data, const std::vector<int>& faults,
                             const Eigen::VectorXd& start = {}) const;
  /// Posterior of the hypothesis `faults`; a parameter that would leave its range is fixed at the
  /// bound. The parameters `at_zero` are fixed at zero, idle ones where the data are linear: place
  /// times force is bilinear, so that a shift without its force would keep a spurious effect.
  /// `scale` [groups] of the discrepancies; empty: the most probable under these faults.
  Posterior InferWithin(const Information& data, const std::vector<int>& faults,
                        const Eigen::VectorXd& scale = {},
                        const std::vector<Eigen::Index>& at_zero = {}) const;
  /// `z` [parameters] with nothing of what is added to what is simulated.
  Eigen::VectorXd Simulated(Eigen::VectorXd z) const;

  /// Qualifying parameters (a place, a time constant) of faults that are not in `faults`.
  std::vector<Eigen::Index> Idle(const std::vector<int>& faults) const;

  FaultModelList All() const;
  /// The parameters of these faults, one after the other.
  std::vector<Eigen::Index> ParametersOf(const std::vector<int>& numbers) const;

 private:
  std::vector<FaultModelPtr> models_;
  std::vector<Eigen::Index> first_;  ///< [faults + 1]
  std::vector<double> tolerance_;    ///< [parameters]
  std::vector<int> group_of_;        ///< [parameters] of a deviation that is inferred; -1: none
};

}  // namespace palpate::diagnosis
