// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <map>
#include <string>
#include <vector>

#include "components/diagnosis/forward/fault_model.hpp"
#include "components/diagnosis/inference/evidence.hpp"

namespace palpate::diagnosis {

/// All faults that a robot may have, where their parameters stand among all, and the prior of them.
/// Faults are known by their number here.
class HypothesisSet {
 public:
  /// `tolerances` (experiment.yaml): fault id -> sigma of its first parameter for a nominal robot,
  /// or of the length of the vector that this is a component of, the others in proportion. One of
  /// something that is no fault here is of no effect.
  HypothesisSet(std::vector<FaultModelPtr> models, std::map<std::string, double> tolerances);

  int size() const { return static_cast<int>(models_.size()); }
  const FaultModel& model(int k) const { return *models_[static_cast<std::size_t>(k)]; }
  Eigen::Index parameter_count() const { return first_.back(); }
  Eigen::Index first(int k) const { return first_[static_cast<std::size_t>(k)]; }
  Eigen::Index count(int k) const { return first(k + 1) - first(k); }
  double ToleranceOf(int k, int parameter) const;

  /// Whether the one is a special case of the other (FaultModel::SpecialCase).
  bool IsSpecialCase(int special, int of) const {
    return model(of).SpecialCase() == model(special).name().id;
  }
  /// Whether a robot may have it as a fault: beyond what a nominal one has of it.
  bool CanBeFault(int k) const;
  /// A robot within its manufacturing tolerances, but for the faults in `faults`.
  GaussianPrior PriorWith(const std::vector<int>& faults) const;
  /// Posterior with the parameters of `faults` where they can be; one that would go beyond ends at
  /// its bound. The parameters `at_zero` are held there, the idle ones where the data are linear:
  /// where a force acts times how large it is is not linear, so that elsewhere, without the force,
  /// a part of it would seem to be left.
  Posterior InferWithin(const Information& data, const std::vector<int>& faults,
                        const std::vector<Eigen::Index>& at_zero = {}) const;

  /// Parameters that only qualify what faults do that are not in `faults`.
  std::vector<Eigen::Index> Idle(const std::vector<int>& faults) const;

  FaultModelList All() const;
  /// The parameters of these faults, one after the other.
  std::vector<Eigen::Index> ParametersOf(const std::vector<int>& numbers) const;

 private:
  std::vector<FaultModelPtr> models_;
  std::vector<Eigen::Index> first_;  ///< [faults + 1]
  std::map<std::string, double> tolerances_;
};

}  // namespace palpate::diagnosis
