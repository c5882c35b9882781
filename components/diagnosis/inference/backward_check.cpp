// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/inference/backward_check.hpp"

#include <algorithm>
#include <optional>

namespace palpate::diagnosis {

namespace {

std::vector<int> Exchanged(std::vector<int> faults, int from, int to) {
  std::replace(faults.begin(), faults.end(), from, to);
  return faults;
}

struct Exchange {
  std::size_t named = 0;
  int rival = -1;
  double ln_gain = 0.0;  ///< as the healthy robot's linear model has it
};

/// The most promising of all exchanges.
std::optional<Exchange> BestExchange(const Fitter& fitter,
                                     const std::vector<std::vector<int>>& rivals,
                                     const Selection& selection) {
  constexpr double kWorthALook = -20.0;  // the linear model is far from where the fits are
  const std::vector<int>& faults = selection.best.faults;
  const double present = fitter.Guess(selection.healthy, faults).ln_evidence;
  std::optional<Exchange> best;
  for (std::size_t k = 0; k < rivals.size(); ++k) {
    for (const int rival : rivals[k]) {
      if (std::find(faults.begin(), faults.end(), rival) != faults.end()) continue;
      const std::vector<int> other = Exchanged(faults, selection.named[k].cause, rival);
      const double gain = fitter.Guess(selection.healthy, other).ln_evidence - present;
      if (gain > (best ? best->ln_gain : kWorthALook)) best = Exchange{k, rival, gain};
    }
  }
  return best;
}

void Drop(std::size_t k, std::vector<std::vector<int>>* rivals, Selection* selection) {
  rivals->erase(rivals->begin() + static_cast<std::ptrdiff_t>(k));
  selection->named.erase(selection->named.begin() + static_cast<std::ptrdiff_t>(k));
}

}  // namespace

void CheckBackward(const Fitter& fitter, double clear_evidence,
                   std::vector<std::vector<int>>* rivals, Selection* selection) {
  if (const auto exchange = BestExchange(fitter, *rivals, *selection)) {
    Choice& choice = selection->named[exchange->named];
    Fit other = fitter.Refine(Exchanged(selection->best.faults, choice.cause, exchange->rival),
                              selection->healthy);
    if (other.status.ok() && other.posterior.ln_evidence > selection->best.posterior.ln_evidence) {
      std::vector<int>& own = (*rivals)[exchange->named];
      std::replace(own.begin(), own.end(), exchange->rival, choice.cause);
      choice.cause = exchange->rival;
      selection->best = std::move(other);
    }
  }
  for (std::size_t k = 0; k < selection->named.size();) {
    Choice& choice = selection->named[k];
    const Fit& best = selection->best;
    std::vector<int> others = best.faults;
    std::erase(others, choice.cause);
    choice.ln_bayes_factor = best.posterior.ln_evidence - fitter.Guess(best, others).ln_evidence;
    if (choice.ln_bayes_factor < clear_evidence) {
      Fit without = fitter.Refine(others, best);
      if (without.status.ok()) {
        selection->best = std::move(without);
        Drop(k, rivals, selection);
        continue;
      }
    }
    const HeldOut before = LeaveOneOut(fitter.book(), best.model, others);
    const HeldOut after = LeaveOneOut(fitter.book(), best.model, best.faults);
    choice.held_out = Compare(before, after);
    for (std::size_t r = 0; r < after.ln_predicted.size(); ++r) {
      choice.ln_gain_of_recording[r] = after.ln_predicted[r] - before.ln_predicted[r];
    }
    ++k;
  }
}

}  // namespace palpate::diagnosis
