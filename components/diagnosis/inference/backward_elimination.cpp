// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/inference/backward_elimination.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "components/diagnosis/inference/canonical_correlation.hpp"
#include "components/diagnosis/inference/forward_selection.hpp"
#include "libs/core/index.hpp"

namespace palpate::diagnosis {

namespace {

/// A named fault for another one.
struct Exchange {
  std::size_t named = 0;
  int other = -1;
  double ln_gain = 0.0;  ///< of the evidence of all together, as linear models have it
};

std::vector<int> Exchanged(std::vector<int> faults, int from, int to) {
  std::replace(faults.begin(), faults.end(), from, to);
  return faults;
}

/// Whether the hypothesis set's fault k is named already, at another place or with another time,
/// too.
bool IsNamed(const HypothesisSet& hypotheses, const std::vector<int>& faults, int k) {
  return std::any_of(faults.begin(), faults.end(), [&](int f) {
    return hypotheses.model(f).name() == hypotheses.model(k).name();
  });
}

/// What could stand in the place of each that is named, the most promising first, each fault by the
/// best of its name. The linear model about the fit tells within one or two of ln p what a refit
/// gives: named faults are far from none, but rivals do about the same as them.
std::vector<Exchange> PromisingExchanges(const Fitter& fitter, const Selection& selection) {
  const HypothesisSet& hypotheses = fitter.hypotheses();
  const Fit& best = selection.best;
  const Information& data = best.model.All();
  std::vector<Exchange> exchanges;
  for (std::size_t n = 0; n < selection.named.size(); ++n) {
    for (int k = 0; k < hypotheses.size(); ++k) {
      if (!hypotheses.CanBeFault(k) || IsNamed(hypotheses, best.faults, k)) continue;
      const std::vector<int> others = Exchanged(best.faults, selection.named[n].fault, k);
      const double promised =
          hypotheses.InferWithin(data, others).ln_evidence - best.posterior.ln_evidence;
      if (promised < kSelectionTuning.exchange_screened) continue;
      const auto same = std::find_if(exchanges.begin(), exchanges.end(), [&](const Exchange& one) {
        return one.named == n && hypotheses.model(one.other).name() == hypotheses.model(k).name();
      });
      if (same == exchanges.end()) {
        exchanges.push_back({n, k, promised});
      } else if (promised > same->ln_gain) {
        *same = {n, k, promised};
      }
    }
  }
  std::sort(exchanges.begin(), exchanges.end(),
            [](const auto& a, const auto& b) { return a.ln_gain > b.ln_gain; });
  return exchanges;
}

/// Of a fault that fits beside all others, in the place of one that is named.
void KeepAsRival(const Fitter& fitter, int named, int rival, double ln_exchanged,
                 Selection* selection) {
  const Fit& best = selection->best;
  const double likeness = CanonicalCorrelation(fitter.hypotheses(), best.model.All(),
                                               best.posterior.scale, named, rival);
  Candidate candidate{.fault = rival,
                      .canonical_correlation = likeness,
                      .refined = true,
                      .in_place_of = named,
                      .ln_exchanged = ln_exchanged};
  if (-ln_exchanged >= IndistinguishableWithin(fitter.hypotheses(), named, candidate)) return;
  std::erase_if(selection->indistinguishable,
                [&](const Candidate& one) { return one.fault == rival; });
  selection->indistinguishable.push_back(std::move(candidate));
}

/// The first of the promising exchanges that keeps its promise. What was named last was chosen
/// beside all others: it stays.
void ExchangeOne(const Fitter& fitter, Selection* selection) {
  const double before = selection->best.posterior.ln_evidence;
  int tried = 0;
  for (const Exchange& exchange : PromisingExchanges(fitter, *selection)) {
    const int most_tried = fitter.IsOutOfTime() ? 1 : kSelectionTuning.most_exchanges;
    if (tried >= most_tried) break;
    if (exchange.named + 1 == selection->named.size()) continue;
    ++tried;
    Choice& choice = selection->named[exchange.named];
    Fit other = fitter.Refine(Exchanged(selection->best.faults, choice.fault, exchange.other),
                              selection->best);
    if (other.posterior.ln_evidence - before < kSelectionTuning.exchange_screened) continue;
    other = fitter.Complete(std::move(other));
    if (!other.status.ok()) continue;
    if (!WhyNoFault(fitter.hypotheses(), other.posterior, exchange.other).empty()) continue;
    const double ln_gain = other.posterior.ln_evidence - before;
    if (ln_gain <= 0.0) {
      KeepAsRival(fitter, choice.fault, exchange.other, ln_gain, selection);
      continue;
    }
    const int named = std::exchange(choice.fault, exchange.other);
    selection->best = fitter.WithAllFaults(std::move(other));
    KeepAsRival(fitter, choice.fault, named, -ln_gain, selection);
    return;
  }
}

/// What each of the named adds to all others; one that adds nothing clear is dropped.
void DropTheUnclear(const Fitter& fitter, double clear_evidence, Selection* selection) {
  for (std::size_t k = 0; k < selection->named.size();) {
    Choice& choice = selection->named[k];
    const Fit& best = selection->best;
    std::vector<int> others = best.faults;
    std::erase(others, choice.fault);
    choice.ln_bayes_factor =
        best.posterior.ln_evidence - fitter.LinearPosterior(best, others).ln_evidence;
    if (choice.ln_bayes_factor < clear_evidence) {
      Fit without = fitter.Complete(fitter.Refine(others, best));
      if (without.status.ok()) {
        selection->best = fitter.WithAllFaults(std::move(without));
        selection->named.erase(selection->named.begin() + ToIndex(k));
        continue;
      }
    }
    const CrossValidation before = LeaveOneOut(fitter.hypotheses(), best.model, others);
    const CrossValidation after = LeaveOneOut(fitter.hypotheses(), best.model, best.faults);
    choice.cross_validation = Compare(before, after);
    for (std::size_t r = 0; r < after.ln_predicted.size(); ++r) {
      choice.ln_gain_of_recording[r] = after.ln_predicted[r] - before.ln_predicted[r];
    }
    ++k;
  }
}

/// Of an exchange; where it was not simulated, what linear models promise.
double SimulatedGain(const Exchange& exchange, int named, const Selection& selection) {
  const auto simulated =
      std::find_if(selection.indistinguishable.begin(), selection.indistinguishable.end(),
                   [&](const Candidate& one) {
                     return one.fault == exchange.other && one.in_place_of == named;
                   });
  return simulated == selection.indistinguishable.end() ? exchange.ln_gain
                                                        : simulated->ln_exchanged;
}

/// Each against nothing, and against all that could stand in its place.
void WeighEach(const Fitter& fitter, Selection* selection) {
  const std::vector<Exchange> exchanges = PromisingExchanges(fitter, *selection);
  const double ln_causes = std::log(static_cast<double>(fitter.hypotheses().size()));
  for (std::size_t n = 0; n < selection->named.size(); ++n) {
    Choice& choice = selection->named[n];
    double others = std::exp(ln_causes - choice.ln_bayes_factor);
    for (const Exchange& one : exchanges) {
      if (one.named == n) others += std::exp(SimulatedGain(one, choice.fault, *selection));
    }
    choice.probability = 1.0 / (1.0 + others);
  }
}

}  // namespace

void EliminateBackward(const Fitter& fitter, double clear_evidence, Selection* selection) {
  ExchangeOne(fitter, selection);
  DropTheUnclear(fitter, clear_evidence, selection);
  const std::vector<int>& faults = selection->best.faults;
  std::erase_if(selection->indistinguishable, [&](const Candidate& rival) {
    return rival.in_place_of >= 0 &&
           std::find(faults.begin(), faults.end(), rival.in_place_of) == faults.end();
  });
  WeighEach(fitter, selection);
}

}  // namespace palpate::diagnosis
