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

/// Hypotheses to separate: the best one from each of its rivals.
struct Question {
  Hypothesis best;
  std::vector<Hypothesis> rivals;  ///< none: nothing is in question
};

/// The rivals of the first fault that was named are those that fit as well, and those whose
/// evidence is less clearly below than what a fault must have (ln BF 10). Where none was named and
/// nothing else is left to explain, faults with some evidence are asked against the nominal robot,
/// or, where that is less likely than the likeliest of them, this one against the others and the
/// nominal robot. An unexplained model error leaves no question: what makes it is not in the
/// catalogue. Faults that are ruled out are in no question.
Question QuestionOf(const Fitter& fitter, const Selection& selection);

/// A proposal and what is expected of it.
struct RankedProposal {
  Proposal proposal;
  CauseName worst_rival;
  double expected_ln_bayes_factor = 0.0;  ///< of the best against that one, whichever is right
  double information = 0.0;               ///< InformationGain about the fault in question
};

/// What a bench can do, the best first: the worst rival's expected ln BF decides, to a tenth, then
/// the information about the fault in question (docs/theory/model_selection.md, Design of the next
/// experiment). The predictions are linear about `selection.best`. `experiment` is on one clock.
std::vector<RankedProposal> RankProposals(const experiment::Experiment& experiment,
                                          const ObservedExperiment& observed,
                                          const robot::RobotBody& body, const Fitter& fitter,
                                          const Selection& selection, const Question& question,
                                          int threads);

/// For the report.
std::vector<ExperimentProposal> Describe(const Question& question,
                                         const std::vector<RankedProposal>& ranked);

}  // namespace palpate::diagnosis
