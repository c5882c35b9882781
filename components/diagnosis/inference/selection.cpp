// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/inference/selection.hpp"

#include <algorithm>

#include "components/diagnosis/inference/backward_elimination.hpp"
#include "components/diagnosis/inference/canonical_correlation.hpp"
#include "components/diagnosis/inference/linear_comparison.hpp"
#include "components/diagnosis/inference/simulated_healthy.hpp"
#include "libs/core/index.hpp"

namespace palpate::diagnosis {

namespace {

/// Whether a fault that fitted as well as one that was named still could stand in its place, now
/// that others are named beside.
bool IsIndistinguishable(const Fitter& fitter, const Selection& selection, const Candidate& rival) {
  const std::vector<int>& faults = selection.best.faults;
  if (std::find(faults.begin(), faults.end(), rival.fault) != faults.end()) return false;
  if (faults.size() < 2 || rival.in_place_of >= 0) return true;
  return std::any_of(faults.begin(), faults.end(), [&](int named) {
    std::vector<int> others = faults;
    std::replace(others.begin(), others.end(), named, rival.fault);
    return fitter.LinearPosterior(selection.best, others).ln_evidence >
           selection.best.posterior.ln_evidence -
               IndistinguishableWithin(fitter.hypotheses(), named, rival);
  });
}

/// What healthy robots of this kind look like, and the evidence that tells a fault from them.
void SetClearEvidence(const HypothesisSet& hypotheses, Selection* selection) {
  const Fit& null_model = selection->null_model;
  if (null_model.model.y.size() == 0) return;
  const LinearComparison comparison(hypotheses, null_model.model.All().H,
                                    hypotheses.PriorWith({}, null_model.posterior.scale));
  const auto simulate = [&] {
    selection->simulated_healthy =
        SimulateHealthyRobots(hypotheses, comparison, null_model, selection->clear_evidence,
                              kSelectionTuning.least_tolerances);
  };
  simulate();
  if (selection->simulated_healthy.ln_bayes_factor_98 <= selection->clear_evidence) return;
  selection->clear_evidence = selection->simulated_healthy.ln_bayes_factor_98;
  simulate();
}

/// Canonical correlations of the most probable candidates.
void CompareCandidates(const HypothesisSet& hypotheses, Selection* selection) {
  constexpr std::size_t kMost = 8;
  for (const Candidate& candidate : selection->candidates) {
    if (selection->compared.size() < kMost) selection->compared.push_back(candidate.fault);
  }
  const auto count = std::ssize(selection->compared);
  selection->canonical_correlation = Eigen::MatrixXd::Identity(count, count);
  const Fit& about = selection->null_model;
  const Information& data = about.model.All();
  for (Eigen::Index a = 0; a < count; ++a) {
    for (Eigen::Index b = 0; b < a; ++b) {
      const double indistinguishable =
          CanonicalCorrelation(hypotheses, data, about.posterior.scale, selection->compared[At(a)],
                               selection->compared[At(b)]);
      selection->canonical_correlation(a, b) = indistinguishable;
      selection->canonical_correlation(b, a) = indistinguishable;
    }
  }
}

}  // namespace

Selection SelectFaults(const ObservedExperiment& observed, const Fitter& fitter,
                       const Fit& as_built, int most, const ReportStep& report,
                       const Rematch& rematch, const std::optional<LikelyFault>& likely) {
  const auto rematched = [&](Fit fit) {
    if (!rematch || !fit.status.ok()) return fit;
    rematch(fit);
    return fitter.Complete(fitter.Remeasured(std::move(fit)));
  };
  const int steps = most + 3;
  Selection selection;
  report(1, steps, kFittingTheNullModel);
  selection.null_model = likely ? as_built : rematched(fitter.Complete(as_built));
  SetClearEvidence(fitter.hypotheses(), &selection);
  selection.best = selection.null_model;
  for (int number = 0; number < most; ++number) {
    if (number > 0 && fitter.IsOutOfTime()) break;
    report(2 + number, steps,
           number == 0 ? "forward selection: first fault" : "forward selection: further fault");
    // Tolerances that were stretched for a fault hide it: its effect on that body is another one.
    const bool is_far = number == 0 && !rematch && !likely && fitter.IsStretched(selection.best);
    ForwardSelectionStep next(observed, fitter, selection.best, is_far ? &as_built : nullptr,
                              likely, selection.clear_evidence);
    const bool found = next.Search();
    if (number == 0) selection.candidates = next.candidates();
    if (!found) break;
    selection.named.push_back(next.choice());
    for (Candidate& indistinguishable : next.Indistinguishable())
      selection.indistinguishable.push_back(indistinguishable);
    if (fitter.hypotheses().model(next.choice().fault).RestartsSearch()) {
      selection.best = fitter.WithAllFaults(next.fit());
      break;
    }
    selection.best = fitter.WithAllFaults(rematched(next.fit()));
    if (number > 0) EliminateBackward(fitter, selection.clear_evidence, &selection);
    if (static_cast<int>(selection.named.size()) <= number) break;  // one was dropped for it
  }
  selection.complete = !fitter.IsOutOfTime();  // else fits may have ended early, too
  std::erase_if(selection.indistinguishable, [&](const Candidate& indistinguishable) {
    return !IsIndistinguishable(fitter, selection, indistinguishable);
  });
  report(steps - 1, steps, "testing the goodness of fit");
  if (rematch && !selection.named.empty())
    selection.null_model = fitter.Remeasured(std::move(selection.null_model));
  selection.goodness_of_fit =
      TestGoodnessOfFit(observed, fitter.marker_rest_m(), fitter.hypotheses(), selection.best);
  CompareCandidates(fitter.hypotheses(), &selection);
  return selection;
}

}  // namespace palpate::diagnosis
