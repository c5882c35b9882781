// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <vector>

#include "components/diagnosis/design/proposal.hpp"
#include "components/diagnosis/inference/selection.hpp"
#include "components/diagnosis/vocabulary/diagnosis_result.hpp"
#include "libs/experiment/experiment.hpp"

namespace palpate::diagnosis {

/// A robot with some faults, as the data so far leave it.
struct Hypothesis {
  CauseName name;  ///< of the fault that is in question; id "no_fault": none
  std::vector<int> faults;
  Posterior posterior;
};

/// What is to be told apart: the best explanation from each of the others.
struct Question {
  Hypothesis best;
  std::vector<Hypothesis> rivals;  ///< none: nothing is in question
};

/// The rivals of the first cause that was named are those that fit as well, and those whose
/// evidence is less clearly below than what a cause must have (ln BF 10). Where none was named and
/// nothing else is left to explain, causes with some evidence are asked against the healthy robot,
/// or, where that is less likely than the likeliest of them, this one against the others and the
/// healthy robot. An unexplained gap leaves no question: what makes it is not in the catalogue.
/// Causes that are ruled out are in no question.
Question QuestionOf(const Fitter& fitter, const Selection& selection);

/// A proposal and what is expected of it.
struct RankedProposal {
  Proposal proposal;
  CauseName worst_rival;
  double expected_ln_bayes_factor = 0.0;  ///< of the best against that one, whichever is right
  double information = 0.0;               ///< InformationGain about the cause in question
};

/// What a bench can do, the best first: the worst rival's expected ln BF decides, to a tenth, then
/// the information about the cause in question (DIAGNOSIS, "Method" 9). The predictions are linear
/// about `selection.best`. `experiment` is on one clock.
std::vector<RankedProposal> RankProposals(const experiment::Experiment& experiment,
                                          const ObservedExperiment& observed,
                                          const robot::RobotBody& body, const Fitter& fitter,
                                          const Selection& selection, const Question& question,
                                          int threads);

/// For the report.
std::vector<ExperimentProposal> Describe(const Question& question,
                                         const std::vector<RankedProposal>& ranked);

}  // namespace palpate::diagnosis
