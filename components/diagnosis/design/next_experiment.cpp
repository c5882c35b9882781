// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/design/next_experiment.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "components/diagnosis/design/divergence.hpp"
#include "components/diagnosis/design/planned_experiment.hpp"
#include "libs/core/parallel_for.hpp"

namespace palpate::diagnosis {

namespace {

/// Which rivals a proposal must separate: more of them ask for more general experiments.
struct DesignTuning {
  double in_question = 10.0;    ///< ln BF below the best
  double some_evidence = 3.0;   ///< ln BF against the null model
  std::size_t most_rivals = 6;  ///< that are compared
  double tie = 0.1;             ///< of expected ln BF; then the information gain decides
};
constexpr DesignTuning kDesignTuning;

Hypothesis HypothesisOf(const Fitter& fitter, const Fit& about, std::vector<int> faults,
                        int fault) {
  Hypothesis hypothesis;
  hypothesis.name = fitter.hypotheses().model(fault).name();
  hypothesis.posterior = fitter.LinearPosterior(about, faults);
  hypothesis.faults = std::move(faults);
  return hypothesis;
}

/// The named faults with one of them exchanged, the one for which that fits best.
Hypothesis Exchanged(const Fitter& fitter, const Selection& selection, int rival) {
  Hypothesis best;
  best.posterior.ln_evidence = -std::numeric_limits<double>::infinity();
  for (const Choice& choice : selection.named) {
    std::vector<int> faults = selection.best.faults;
    std::replace(faults.begin(), faults.end(), choice.fault, rival);
    Hypothesis one = HypothesisOf(fitter, selection.best, std::move(faults), rival);
    if (one.posterior.ln_evidence > best.posterior.ln_evidence) best = std::move(one);
  }
  return best;
}

/// Numbers of the rivals of the first named fault.
std::vector<int> RivalsOf(const Selection& selection) {
  std::vector<int> rivals;
  const auto add = [&](int fault) {
    const auto& faults = selection.best.faults;
    const bool known = std::find(faults.begin(), faults.end(), fault) != faults.end() ||
                       std::find(rivals.begin(), rivals.end(), fault) != rivals.end();
    if (!known && rivals.size() < kDesignTuning.most_rivals) rivals.push_back(fault);
  };
  for (const Candidate& indistinguishable : selection.indistinguishable)
    add(indistinguishable.fault);
  const auto& candidates = selection.candidates;
  const auto first = std::find_if(candidates.begin(), candidates.end(), [&](const auto& one) {
    return one.fault == selection.named.front().fault;
  });
  if (first == candidates.end()) return rivals;
  for (const Candidate& one : candidates) {
    if (one.ruled_out) continue;
    if (one.ln_bayes_factor > first->ln_bayes_factor - kDesignTuning.in_question) add(one.fault);
  }
  return rivals;
}

/// Where none was named: the faults that there is some evidence for, the most first.
std::vector<Candidate> WithSomeEvidence(const Selection& selection) {
  std::vector<Candidate> some = selection.candidates;
  std::erase_if(some, [](const Candidate& one) {
    return one.ruled_out || one.ln_bayes_factor < kDesignTuning.some_evidence;
  });
  SortByEvidence(&some);
  if (some.size() > kDesignTuning.most_rivals) some.resize(kDesignTuning.most_rivals);
  return some;
}

/// Faults that any hypothesis allows.
std::vector<int> ColumnsOf(const HypothesisSet& hypotheses, const Question& question) {
  std::set<int> columns;
  const auto add = [&](const Hypothesis& hypothesis) {
    const GaussianPrior prior = hypotheses.PriorWith(hypothesis.faults);
    for (int k = 0; k < hypotheses.size(); ++k) {
      if (!prior.sigma.segment(hypotheses.first(k), hypotheses.count(k)).isZero(0.0))
        columns.insert(k);
    }
  };
  add(question.best);
  for (const Hypothesis& rival : question.rivals) add(rival);
  return {columns.begin(), columns.end()};
}

/// What is expected of one proposal, whose rows these are; infinite where there are none.
RankedProposal Rank(const Proposal& proposal, const Eigen::MatrixXd& J, const Question& question,
                    const std::vector<Eigen::Index>& parameters) {
  RankedProposal ranked{.proposal = proposal, .worst_rival = {}};
  ranked.expected_ln_bayes_factor = std::numeric_limits<double>::infinity();
  if (J.rows() == 0) return ranked;
  const Posterior& posterior = question.best.posterior;
  const Prediction best(J, posterior);
  for (const Hypothesis& one : question.rivals) {
    const Prediction rival(J, one.posterior);
    const double expected =
        std::min(ExpectedLnBayesFactor(best, rival), ExpectedLnBayesFactor(rival, best));
    if (expected >= ranked.expected_ln_bayes_factor) continue;
    ranked.expected_ln_bayes_factor = expected;
    ranked.worst_rival = one.name;
  }
  ranked.information = InformationGain(J, posterior, parameters, best);
  return ranked;
}

bool IsBetter(const RankedProposal& a, const RankedProposal& b) {
  const double of_a = std::round(a.expected_ln_bayes_factor / kDesignTuning.tie);
  const double of_b = std::round(b.expected_ln_bayes_factor / kDesignTuning.tie);
  return of_a != of_b ? of_a > of_b : a.information > b.information;
}

}  // namespace

Question QuestionOf(const Fitter& fitter, const Selection& selection) {
  Question question;
  const Fit& best = selection.best;
  if (!selection.named.empty()) {
    question.best = HypothesisOf(fitter, best, best.faults, selection.named.front().fault);
    for (const int rival : RivalsOf(selection)) {
      question.rivals.push_back(Exchanged(fitter, selection, rival));
    }
    return question;
  }
  if (!selection.goodness_of_fit.passed) return question;
  const std::vector<Candidate> some = WithSomeEvidence(selection);
  if (some.empty()) return question;
  question.best = {.name = {"no_fault", {"body"}}, .faults = {}, .posterior = best.posterior};
  for (const Candidate& one : some) {
    question.rivals.push_back(HypothesisOf(fitter, best, {one.fault}, one.fault));
  }
  const double of_all_causes = std::log(static_cast<double>(selection.candidates.size()));
  if (some.front().ln_bayes_factor > of_all_causes) std::swap(question.best, question.rivals[0]);
  return question;
}

std::vector<RankedProposal> RankProposals(const experiment::Experiment& experiment,
                                          const ObservedExperiment& observed,
                                          const robot::RobotBody& body, const Fitter& fitter,
                                          const Selection& selection, const Question& question,
                                          int threads) {
  if (question.rivals.empty()) return {};
  const std::vector<Proposal> proposals = BenchProposals(body, observed);
  if (proposals.empty()) return {};
  const HypothesisSet& hypotheses = fitter.hypotheses();
  const ObservedExperiment planned = ObserveProposals(experiment, observed, body, proposals);
  const LinearModel model =
      PredictProposals(planned, body, hypotheses, selection.best, ColumnsOf(hypotheses, question),
                       fitter.noise(), threads);
  const std::vector<int>& in_question =
      question.best.faults.empty() ? question.rivals.front().faults : question.best.faults;
  const std::vector<Eigen::Index> parameters = hypotheses.ParametersOf({in_question.front()});
  std::vector<RankedProposal> ranked(proposals.size());
  ParallelFor(proposals.size(), threads, [&](std::size_t k) {
    ranked[k] =
        Rank(proposals[k], model.RowsOf(observed.recordings.size() + k), question, parameters);
  });
  std::erase_if(ranked, [](const RankedProposal& one) {
    return !std::isfinite(one.expected_ln_bayes_factor);
  });
  std::stable_sort(ranked.begin(), ranked.end(), IsBetter);
  return ranked;
}

std::vector<ExperimentProposal> Describe(const Question& question,
                                         const std::vector<RankedProposal>& ranked) {
  std::vector<ExperimentProposal> proposals;
  for (const RankedProposal& one : ranked) {
    proposals.push_back({.title = one.proposal.title,
                         .by_hand = one.proposal.by_hand,
                         .first = question.best.name,
                         .second = one.worst_rival,
                         .expected_ln_bayes_factor = one.expected_ln_bayes_factor});
  }
  return proposals;
}

}  // namespace palpate::diagnosis
