// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/explain/limits.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "components/diagnosis/inference/forward_selection.hpp"
#include "components/diagnosis/inference/linear_comparison.hpp"
#include "libs/core/index.hpp"

namespace palpate::diagnosis {

namespace {

/// Of the places of a fault the one where it shows least.
void AddSize(const HypothesisSet& hypotheses, const SmallestSize& size, DiagnosisResult* result) {
  const FaultModel& fault = hypotheses.model(size.fault);
  const FaultParameter& parameter = fault.parameters()[At(size.parameter)];
  if (parameter.fault_at != 0.0) return;  // it is there or not, and has no size
  const double value =
      std::isfinite(size.z) ? parameter.ValueOf(size.z) : std::numeric_limits<double>::quiet_NaN();
  const auto known =
      std::find_if(result->findable.begin(), result->findable.end(),
                   [&](const FindableSize& one) { return one.name == fault.name(); });
  if (known == result->findable.end()) {
    result->findable.push_back({fault.name(), fault.words(), parameter.name, value});
    return;
  }
  if (std::isnan(known->value)) return;
  // A compliance is reported as a stiffness: there the smallest value is the largest fault.
  const bool inverse = parameter.scale == FaultParameter::Scale::kInverse;
  if (!(std::isfinite(value) && (inverse ? value > known->value : value < known->value)))
    known->value = value;
}

}  // namespace

void DescribeLimits(const HypothesisSet& hypotheses, const Selection& selection,
                    DiagnosisResult* result) {
  const Fit& null_model = selection.null_model;
  if (null_model.model.y.size() == 0) return;
  const Eigen::MatrixXd& H = null_model.model.All().H;
  const LinearComparison comparison(hypotheses, H,
                                    hypotheses.PriorWith({}, null_model.posterior.scale));
  for (const SmallestSize& size :
       FindSmallestSizes(hypotheses, comparison, H, selection.clear_evidence,
                         kSelectionTuning.least_tolerances)) {
    AddSize(hypotheses, size, result);
  }
  result->simulated_healthy = selection.simulated_healthy;
  result->clear_evidence = selection.clear_evidence;
  if (null_model.posterior.scale.size() != kDiscrepancyGroups) return;
  result->cable_discrepancy =
      null_model.posterior.scale[static_cast<Eigen::Index>(DiscrepancyGroup::kCables)];
  result->stiffness_discrepancy =
      null_model.posterior.scale[static_cast<Eigen::Index>(DiscrepancyGroup::kStiffness)];
}

}  // namespace palpate::diagnosis
