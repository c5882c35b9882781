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

namespace palpate::diagnosis {

/// Which faults explain an experiment.
struct Selection {
  Fit null_model;                            ///< within the manufacturing tolerances
  Fit best;                                  ///< with the faults that were named
  std::vector<Choice> named;                 ///< as they were found
  std::vector<Candidate> candidates;         ///< for the first place, the most probable first
  std::vector<Candidate> indistinguishable;  ///< that fit as well as what was named
  bool complete = true;                   ///< else the fitter's time was over before the search was
  GoodnessOfFit goodness_of_fit;          ///< of `best`
  std::vector<int> compared;              ///< the faults of the most probable candidates
  Eigen::MatrixXd canonical_correlation;  ///< [compared x compared] as
                                          ///< Candidate::canonical_correlation, in [0, 1]
};

/// "3 of 12: screening"; parts are equally long as far as that is known.
using ReportStep = std::function<void(int done, int of, const std::string& what)>;

/// Brings what was measured up to date with a fit's shapes, as the surface that depth frames show
/// is matched with the body about where it is thought to be.
using Rematch = std::function<void(const Fit&)>;

/// Names faults one after the other (docs/theory/model_selection.md): all are screened by the
/// evidence of the linear model, the best simulated again; the best is named if the evidence for it
/// is clear, it predicts recordings that it was not fitted to, and it is beyond the tolerances. At
/// most `most`. `rematch` is called about the nominal robot and about each set of faults that is
/// named; none: nothing that was measured depends on where the body is. `likely` is simulated
/// whatever the linear model says of it; the robot without it is far off then, and is not fitted.
Selection SelectFaults(const ObservedExperiment& observed, const Fitter& fitter,
                       const Fit& as_built, int most, const ReportStep& report,
                       const Rematch& rematch = nullptr,
                       const std::optional<CauseName>& likely = {});

}  // namespace palpate::diagnosis
