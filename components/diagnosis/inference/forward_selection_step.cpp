// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/inference/forward_selection_step.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "components/diagnosis/inference/fault_size.hpp"
#include "components/diagnosis/inference/other_places.hpp"
#include "libs/core/text.hpp"

namespace palpate::diagnosis {

namespace {

constexpr double kWorthALook = 10.0;     ///< below the best, ln BF, to be simulated anew
constexpr double kMayGetClear = 5.0;     ///< ln BF that a further cause promises before
constexpr std::size_t kMostRefined = 4;  ///< in a round
constexpr int kMostRounds = 2;
constexpr double kImpossible = -1e9;  ///< ln BF of what cannot be simulated

}  // namespace

double AlikeWithin(const HypothesisSet& hypotheses, int named, const Candidate& rival) {
  constexpr double kSameEffect = 0.95;
  const bool same =
      rival.canonical_correlation > kSameEffect && !hypotheses.IsSpecialCase(rival.cause, named);
  return same ? kClearEvidence : kAlikeEvidence;
}

bool ForwardSelectionStep::Look() {
  candidates_ = Screen(fitter_, before_, before_.faults);
  if (likely_) TryOut(*likely_);
  if (candidates_.empty() || candidates_.front().ln_bayes_factor < kAlikeEvidence) {
    Explain();
    return false;
  }
  const CrossValidation held_out = LeaveOneOut(fitter_.hypotheses(), before_.model, before_.faults);
  for (int round = 0; round < kMostRounds && found_ >= candidates_.size(); ++round) {
    if (round > 0 && !AreOthersPromising()) break;
    RefineTheBest();
    FindOneThatIsClear(held_out);
  }
  Explain();
  return found_ < candidates_.size();
}

std::vector<Candidate> ForwardSelectionStep::Alike() const {
  std::vector<Candidate> alike;
  for (std::size_t k = 0; k < candidates_.size(); ++k) {
    const Candidate& rival = candidates_[k];
    const double behind = candidates_[found_].ln_bayes_factor - rival.ln_bayes_factor;
    if (k == found_ || rival.ruled_out || IsSpecialCaseOf(found_, k)) continue;
    const double within = AlikeWithin(fitter_.hypotheses(), candidates_[found_].cause, rival);
    if (behind < within) alike.push_back(rival);
  }
  return alike;
}

bool ForwardSelectionStep::IsSpecialCaseOf(std::size_t special, std::size_t k) const {
  return fitter_.hypotheses().IsSpecialCase(candidates_[special].cause, candidates_[k].cause);
}

void ForwardSelectionStep::TryOut(const CauseName& name) {
  const auto tried = std::find_if(
      candidates_.begin(), candidates_.end(),
      [&](const Candidate& one) { return fitter_.hypotheses().cause(one.cause).name() == name; });
  if (tried == candidates_.end()) return;
  tried_ = fitter_.WithFaults(With(before_.faults, tried->cause), before_);
  if (!tried_.status.ok()) return;
  tried->ln_guessed = tried_.posterior.ln_evidence - before_.posterior.ln_evidence;
  tried->ln_bayes_factor = tried->ln_guessed;
  SortByEvidence(&candidates_);
}

bool ForwardSelectionStep::AreOthersPromising() const {
  const std::size_t next = fits_.size();
  if (next >= candidates_.size() || fitter_.IsOutOfTime()) return false;
  if (candidates_[next].ln_bayes_factor < kClearEvidence) return false;
  for (std::size_t k = 0; k < fits_.size(); ++k) {
    const Candidate& tried = candidates_[k];
    const bool can_be = !tried.ruled_out && tried.ln_bayes_factor >= kClearEvidence;
    if (can_be && !PromisesAnotherMoreThan(k)) return false;
  }
  return true;
}

bool ForwardSelectionStep::PromisesAnotherMoreThan(std::size_t k) const {
  const std::size_t next = fits_.size();
  return next < candidates_.size() &&
         candidates_[next].ln_bayes_factor > candidates_[k].ln_bayes_factor + kWorthALook;
}

void ForwardSelectionStep::FindOneThatIsClear(const CrossValidation& held_out) {
  for (std::size_t k = 0; k < fits_.size(); ++k) {
    if (!candidates_[k].why_not.empty() || PromisesAnotherMoreThan(k)) continue;
    if (!IsClear(held_out, k)) continue;
    found_ = k;
    return;
  }
}

void ForwardSelectionStep::PutSpecialCasesNext(std::size_t first, std::size_t end) {
  for (std::size_t k = first; k < end; ++k) {
    for (std::size_t special = k + 1; special < candidates_.size(); ++special) {
      if (!IsSpecialCaseOf(special, k)) continue;
      const auto next = candidates_.begin() + static_cast<std::ptrdiff_t>(k + 1);
      std::rotate(next, candidates_.begin() + static_cast<std::ptrdiff_t>(special),
                  candidates_.begin() + static_cast<std::ptrdiff_t>(special + 1));
    }
  }
}

void ForwardSelectionStep::RefineTheBest() {
  const std::size_t first = fits_.size();
  const std::size_t end = std::min(first + kMostRefined, candidates_.size());
  PutSpecialCasesNext(first, end);
  const double least = before_.faults.empty() ? kAlikeEvidence : kMayGetClear;
  double best = -std::numeric_limits<double>::infinity();
  for (std::size_t k = first; k < end; ++k) {
    Candidate& candidate = candidates_[k];
    const bool special = k > first && IsSpecialCaseOf(k, k - 1);
    if (!special && candidate.ln_bayes_factor < std::max(least, best - kWorthALook)) break;
    if (k > 0 && fitter_.IsOutOfTime()) break;
    Fit fit = RefineFromItsStarts(&candidate);
    const double now = fit.posterior.ln_evidence - before_.posterior.ln_evidence;
    candidate.ln_bayes_factor += fit.status.ok() ? now - candidate.ln_guessed : kImpossible;
    candidate.refined = true;
    // Where one gains on what was guessed of it, another may, too.
    best = std::max(best, std::min(candidate.ln_guessed, candidate.ln_bayes_factor));
    fits_.push_back(std::move(fit));
  }
  SortRefined();
  // Out of time, only what may be named is completed (IsClear).
  for (std::size_t k = fits_.size(); k-- > 0 && !fitter_.IsOutOfTime();) {
    const double behind = candidates_.front().ln_bayes_factor - candidates_[k].ln_bayes_factor;
    // How likely a further one is that cannot get clear, nobody asks.
    if (behind < kAlikeEvidence && candidates_[k].ln_bayes_factor >= least) Complete(k);
  }
  SortRefined();
}

Fit ForwardSelectionStep::RefineFromItsStarts(Candidate* candidate) const {
  constexpr int kRoundsToCompare = 3;
  if (candidate->starts.size() < 2) {
    const std::vector<int> faults = With(before_.faults, candidate->cause);
    const bool was_tried = tried_.status.ok() && tried_.faults == faults;
    return fitter_.Refine(faults, was_tried ? tried_ : before_);
  }
  Fit best;
  for (const int cause : candidate->starts) {
    if (!best.faults.empty() && fitter_.IsOutOfTime()) break;
    Fit fit =
        fitter_.Refine(With(before_.faults, cause), before_, kRoundsToCompare, Detail::kMiddles);
    const bool better = fit.status.ok() && (!best.status.ok() ||
                                            fit.posterior.ln_evidence > best.posterior.ln_evidence);
    if (!better && !best.faults.empty()) continue;
    candidate->cause = cause;
    best = std::move(fit);
  }
  const bool hopeless = best.posterior.ln_evidence < before_.posterior.ln_evidence;
  if (!best.status.ok() || hopeless) return best;
  return fitter_.Refine(best.faults, best);
}

void ForwardSelectionStep::Complete(std::size_t k) {
  if (fits_[k].arrived) return;
  const double before = fits_[k].posterior.ln_evidence;
  fits_[k] = AtTheBestPlace(fitter_, fitter_.Complete(std::move(fits_[k])), &candidates_[k].cause);
  const double now = fits_[k].posterior.ln_evidence;
  candidates_[k].ln_bayes_factor += fits_[k].status.ok() ? now - before : kImpossible;
}

void ForwardSelectionStep::SortRefined() {
  std::vector<std::size_t> order(fits_.size());
  for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return candidates_[a].ln_bayes_factor > candidates_[b].ln_bayes_factor;
  });
  std::vector<Candidate> sorted = candidates_;
  std::vector<Fit> fits;
  for (std::size_t k = 0; k < order.size(); ++k) {
    sorted[k] = candidates_[order[k]];
    fits.push_back(std::move(fits_[order[k]]));
  }
  candidates_ = std::move(sorted);
  fits_ = std::move(fits);
}

bool ForwardSelectionStep::IsClear(const CrossValidation& before, std::size_t k) {
  Candidate& candidate = candidates_[k];
  if (candidate.ln_bayes_factor >= kClearEvidence) Complete(k);
  if (candidate.ln_bayes_factor < kClearEvidence) {
    candidate.why_not = "the evidence for it is not clear (ln BF " +
                        FormatNumber(std::round(10.0 * candidate.ln_bayes_factor) / 10.0) + ")";
    return false;
  }
  candidate.why_not = WhyNoFault(fitter_.hypotheses(), fits_[k].posterior, candidate.cause);
  candidate.ruled_out = !candidate.why_not.empty();
  if (candidate.ruled_out) return false;
  const CrossValidation after = LeaveOneOut(fitter_.hypotheses(), fits_[k].model, fits_[k].faults);
  Choice choice{.cause = candidate.cause, .ln_bayes_factor = candidate.ln_bayes_factor};
  choice.held_out = Compare(before, after);
  for (std::size_t r = 0; r < after.ln_predicted.size(); ++r) {
    choice.ln_gain_of_recording.push_back(after.ln_predicted[r] - before.ln_predicted[r]);
  }
  if (!choice.held_out.clear && SeenIn(k) > 1 && !KeepsTolerances(k)) {
    candidate.why_not =
        "with it recordings that it was not fitted to are predicted no better (ln BF " +
        FormatNumber(std::round(10.0 * choice.held_out.ln_gain) / 10.0) + ", " +
        FormatNumber(std::round(100.0 * choice.held_out.relative)) +
        " % of the error beyond the noise)";
    return false;
  }
  choice.probability = Probability(k);
  choice_ = std::move(choice);
  return true;
}

double ForwardSelectionStep::Probability(std::size_t k) const {
  const double ln_share = -std::log(static_cast<double>(candidates_.size()));
  double others = std::exp(-candidates_[k].ln_bayes_factor - ln_share);
  for (std::size_t other = 0; other < candidates_.size(); ++other) {
    if (candidates_[other].ruled_out) continue;
    others += std::exp(candidates_[other].ln_bayes_factor - candidates_[k].ln_bayes_factor);
  }
  return 1.0 / others;
}

bool ForwardSelectionStep::KeepsTolerances(std::size_t k) const {
  const std::vector<Eigen::Index> own = fitter_.hypotheses().ParametersOf(fits_[k].faults);
  const GaussianPrior prior = fitter_.hypotheses().PriorWith({});
  const auto off = [&](const Fit& fit) {
    double sum = 0.0;
    for (Eigen::Index p = 0; p < prior.sigma.size(); ++p) {
      const bool is_own = std::find(own.begin(), own.end(), p) != own.end();
      if (is_own || prior.sigma[p] == 0.0) continue;
      sum += std::pow(fit.posterior.mean[p] / prior.sigma[p], 2);
    }
    return sum;
  };
  return off(before_) - off(fits_[k]) > 2.0 * kClearEvidence;
}

int ForwardSelectionStep::SeenIn(std::size_t k) const {
  constexpr double kClearly = 5.0;
  int recordings = 0;
  Eigen::Index first = 0;
  Eigen::Index first_before = 0;
  for (std::size_t r = 0; r < observed_.recordings.size(); ++r) {
    const auto misfit = [&](const Fit& fit, Eigen::Index begin) {
      const Eigen::Index rows = fit.model.of_recording[r].rows;
      return (fit.model.y.segment(begin, rows) -
              fit.model.J.middleRows(begin, rows) * fit.posterior.mean)
          .squaredNorm();
    };
    const double gain = 0.5 * (misfit(before_, first_before) - misfit(fits_[k], first));
    if (gain > kClearly) ++recordings;
    first += fits_[k].model.of_recording[r].rows;
    first_before += before_.model.of_recording[r].rows;
  }
  return recordings;
}

void ForwardSelectionStep::Explain() {
  const HypothesisSet& hypotheses = fitter_.hypotheses();
  const int first = found_ < candidates_.size() ? candidates_[found_].cause : -1;
  for (std::size_t k = 0; k < candidates_.size(); ++k) {
    Candidate& candidate = candidates_[k];
    if (first >= 0 && k != found_) {
      candidate.canonical_correlation =
          CanonicalCorrelation(hypotheses, before_.model, first, candidate.cause);
    }
    if (k == found_ || !candidate.why_not.empty()) continue;
    if (k < fits_.size() && PromisesAnotherMoreThan(k)) {
      candidate.why_not = "another cause that promises more was not simulated";
      continue;
    }
    candidate.why_not =
        first >= 0 ? "another cause explains more"
                   : "the evidence for it is not clear (ln BF " +
                         FormatNumber(std::round(10.0 * candidate.ln_bayes_factor) / 10.0) + ")";
  }
}

}  // namespace palpate::diagnosis
