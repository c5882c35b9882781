// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <vector>

#include "components/diagnosis/inference/fitter.hpp"

namespace palpate::diagnosis {

/// A cause that was looked at as the next one, and what became of it.
struct Candidate {
  int cause = -1;  ///< the best of those that have its name (places, relaxation times)
  double ln_bayes_factor = 0.0;  ///< against the causes named before; those of one name averaged
  double ln_guessed = 0.0;       ///< the same of that one alone, before it was simulated
  double canonical_correlation =
      0.0;                   ///< canonical correlation of its effect with that of the first named
  bool refined = false;      ///< simulated anew where it fits best
  std::string why_not = {};  ///< empty: named
  bool ruled_out = false;    ///< where it fits best it is no fault, or more than any robot has
  std::vector<int> starts = {};  ///< causes of its name to simulate, the most probable first
};

/// `faults`, and one more.
std::vector<int> With(std::vector<int> faults, int cause);

/// All causes that could be the next beside `faults`, by the linear model of `about`, the most
/// probable first; the best of each name stands for it.
std::vector<Candidate> Screen(const Fitter& fitter, const Fit& about,
                              const std::vector<int>& faults);
/// The most probable first.
void SortByEvidence(std::vector<Candidate>* candidates);

/// The largest canonical correlation between what two causes do, what building tolerances can make
/// up for taken out; in [0, 1].
double CanonicalCorrelation(const HypothesisSet& hypotheses, const LinearModel& model, int a,
                            int b);

}  // namespace palpate::diagnosis
