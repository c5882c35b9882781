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

/// Which causes explain an experiment.
struct Selection {
  Fit null_model;                            ///< within the manufacturing tolerances
  Fit best;                                  ///< with the causes that were named
  std::vector<Choice> named;                 ///< as they were found
  std::vector<Candidate> candidates;         ///< for the first place, the most probable first
  std::vector<Candidate> indistinguishable;  ///< that fit as well as what was named
  bool complete = true;           ///< else the fitter's time was over before the search was
  GoodnessOfFit goodness_of_fit;  ///< of `best`
  std::vector<int> compared;      ///< the causes of the most probable candidates
  Eigen::MatrixXd
      canonical_correlation;  ///< [compared x compared] as Candidate::likeness, in [0, 1]
};

/// "3 of 12: screening"; parts are alike long as far as that is known.
using ReportStep = std::function<void(int done, int of, const std::string& what)>;

/// Brings what was measured up to date with a fit's shapes, as the skin that pictures show is
/// matched with the body about where it is thought to be.
using Rematch = std::function<void(const Fit&)>;

/// Names causes one after the other (DIAGNOSIS, "Method" 3-7): all are screened by the evidence of
/// the linear model, the best simulated anew; the best is named if the evidence for it is clear, it
/// predicts recordings that it was not fitted to, and it is beyond the tolerances. At most `most`.
/// `rematch` is called about the healthy robot and about each set of causes that is named; none:
/// nothing that was measured depends on where the body is. `likely` is simulated whatever the
/// linear model says of it; the robot without it is far off then, and is not fitted.
Selection SelectFaults(const ObservedExperiment& observed, const Fitter& fitter,
                       const Fit& as_built, int most, const ReportStep& report,
                       const Rematch& rematch = nullptr,
                       const std::optional<CauseName>& likely = {});

}  // namespace palpate::diagnosis
