// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "components/diagnosis/inference/fitter.hpp"
#include "components/diagnosis/inference/forward_selection.hpp"
#include "components/diagnosis/inference/goodness_of_fit.hpp"
#include "components/diagnosis/vocabulary/diagnosis_result.hpp"

namespace palpate::diagnosis {

/// The result of forward selection with backward elimination.
struct Selection {
  Fit null_model;  ///< within the manufacturing tolerances
  Fit best;        ///< with the faults that were named; its columns are of all (Fit::of_all_faults)
  std::vector<Choice> named;                 ///< as they were found
  std::vector<Candidate> candidates;         ///< for the first place, the most probable first
  std::vector<Candidate> indistinguishable;  ///< that fit as well as what was named
  SimulatedHealthy simulated_healthy;        ///< of the null model
  /// ln BF that a fault must have to be named: the tuning's, or more where more than 2 % of
  /// simulated healthy robots have a fault of that.
  double clear_evidence = kSelectionTuning.clear_evidence;
  bool complete = true;                   ///< else the fitter's time was over before the search was
  GoodnessOfFit goodness_of_fit;          ///< of `best`
  std::vector<int> compared;              ///< the faults of the most probable candidates
  Eigen::MatrixXd canonical_correlation;  ///< [compared x compared] as
                                          ///< Candidate::canonical_correlation, in [0, 1]
};

/// The step of SelectFaults that no time limit shortens, as it is reported.
inline constexpr char kFittingTheNullModel[] = "fitting the null model";

/// "3 of 12: screening"; parts are equally long as far as that is known.
using ReportStep = std::function<void(int done, int of, const std::string& what)>;

/// Matches the clouds again with the shapes of a fit, and updates the surface measurements.
using Rematch = std::function<void(const Fit&)>;

/// Forward selection of at most `most` faults, with backward elimination after each further one
/// (docs/theory/model_selection.md). `rematch` is called for the null model and for each set of
/// named faults; nullptr: no measurement depends on the shape of the body. `likely` is simulated
/// whatever the linear model says of it; the null model, far off without it, is then not fitted.
Selection SelectFaults(const ObservedExperiment& observed, const Fitter& fitter,
                       const Fit& as_built, int most, const ReportStep& report,
                       const Rematch& rematch = nullptr,
                       const std::optional<LikelyFault>& likely = {});

}  // namespace palpate::diagnosis
