// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/inference/selection.hpp"

#include <algorithm>

#include "components/diagnosis/inference/backward_elimination.hpp"

namespace palpate::diagnosis {

namespace {

/// Whether a cause that fitted as well as one that was named still could stand in its place, now
/// that others are named beside.
bool IsAlike(const Fitter& fitter, const Selection& selection, const Candidate& rival) {
  const std::vector<int>& faults = selection.best.faults;
  if (std::find(faults.begin(), faults.end(), rival.cause) != faults.end()) return false;
  if (faults.size() < 2) return true;
  return std::any_of(faults.begin(), faults.end(), [&](int named) {
    std::vector<int> others = faults;
    std::replace(others.begin(), others.end(), named, rival.cause);
    return fitter.Guess(selection.best, others).ln_evidence >
           selection.best.posterior.ln_evidence - AlikeWithin(fitter.hypotheses(), named, rival);
  });
}

/// How alike the most probable candidates are to each other.
void CompareCandidates(const HypothesisSet& hypotheses, Selection* selection) {
  constexpr std::size_t kMost = 8;
  for (const Candidate& candidate : selection->candidates) {
    if (selection->compared.size() < kMost) selection->compared.push_back(candidate.cause);
  }
  const auto count = std::ssize(selection->compared);
  selection->canonical_correlation = Eigen::MatrixXd::Identity(count, count);
  for (Eigen::Index a = 0; a < count; ++a) {
    for (Eigen::Index b = 0; b < a; ++b) {
      const double alike = CanonicalCorrelation(hypotheses, selection->healthy.model,
                                                selection->compared[static_cast<std::size_t>(a)],
                                                selection->compared[static_cast<std::size_t>(b)]);
      selection->canonical_correlation(a, b) = alike;
      selection->canonical_correlation(b, a) = alike;
    }
  }
}

}  // namespace

Selection SelectCauses(const ObservedExperiment& observed, const Fitter& fitter,
                       const Fit& as_built, int most, const ReportStep& report,
                       const LookAgain& look_again, const std::optional<CauseName>& likely) {
  const auto seen_again = [&](Fit fit) {
    if (!look_again || !fit.status.ok()) return fit;
    look_again(fit);
    return fitter.Complete(fitter.SeenAnew(std::move(fit)));
  };
  const int steps = most + 3;
  Selection selection;
  report(1, steps, "fitting a healthy robot");
  selection.healthy = likely ? as_built : seen_again(fitter.Complete(as_built));
  selection.best = selection.healthy;
  for (int number = 0; number < most; ++number) {
    if (number > 0 && fitter.IsOutOfTime()) break;
    report(2 + number, steps, number == 0 ? "looking for a cause" : "looking for a further cause");
    ForwardSelectionStep next(observed, fitter, selection.best, likely);
    const bool found = next.Look();
    if (number == 0) selection.candidates = next.candidates();
    if (!found) break;
    selection.named.push_back(next.choice());
    for (Candidate& alike : next.Alike()) selection.alike.push_back(alike);
    if (fitter.hypotheses().cause(next.choice().cause).BeginsAnew()) {
      selection.best = next.fit();
      break;
    }
    selection.best = seen_again(next.fit());
    if (number > 0) EliminateBackward(fitter, kClearEvidence, &selection);
    if (static_cast<int>(selection.named.size()) <= number) break;  // one was dropped for it
  }
  selection.complete = !fitter.IsOutOfTime();  // else fits may have ended early, too
  std::erase_if(selection.alike,
                [&](const Candidate& alike) { return !IsAlike(fitter, selection, alike); });
  report(steps - 1, steps, "looking at what is left");
  if (look_again && !selection.named.empty())
    selection.healthy = fitter.SeenAnew(std::move(selection.healthy));
  selection.goodness_of_fit =
      TestGoodnessOfFit(observed, fitter.marker_rest_m(), fitter.hypotheses(), selection.best);
  CompareCandidates(fitter.hypotheses(), &selection);
  return selection;
}

}  // namespace palpate::diagnosis
