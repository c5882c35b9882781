// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/inference/selection.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "components/diagnosis/inference/backward_check.hpp"
#include "components/diagnosis/inference/fault_size.hpp"
#include "components/diagnosis/inference/other_places.hpp"
#include "components/diagnosis/inference/screening.hpp"
#include "libs/core/text.hpp"

namespace palpate::diagnosis {

namespace {

constexpr double kClearEvidence = 10.0;  ///< ln BF that a cause must have
constexpr double kAlike = 3.0;           ///< ln BF within which causes fit alike
constexpr double kWorthALook = 10.0;     ///< below the best, ln BF, to be simulated anew
constexpr double kMayGetClear = 5.0;     ///< ln BF that a further cause promises before
constexpr std::size_t kMostRefined = 4;  ///< in a round
constexpr int kMostRounds = 2;
constexpr double kImpossible = -1e9;  ///< ln BF of what cannot be simulated

/// Looks for one further cause.
class NextCause {
 public:
  NextCause(const ObservedExperiment& observed, const Fitter& fitter, const Fit& before,
            const std::optional<CauseName>& likely)
      : observed_(observed), fitter_(fitter), before_(before), likely_(likely) {}

  /// Whether there is one; then choice() and fit() are about it.
  bool Look() {
    candidates_ = Screen(fitter_, before_, before_.faults);
    if (likely_) TryOut(*likely_);
    if (candidates_.empty() || candidates_.front().ln_bayes_factor < kAlike) {
      Explain();
      return false;
    }
    const HeldOut held_out = LeaveOneOut(fitter_.book(), before_.model, before_.faults);
    for (int round = 0; round < kMostRounds && found_ >= candidates_.size(); ++round) {
      if (round > 0 && !AreOthersPromising()) break;
      RefineTheBest();
      FindOneThatIsClear(held_out);
    }
    if (found_ < candidates_.size()) PreferASpecialCase(held_out);
    Explain();
    return found_ < candidates_.size();
  }

  const Choice& choice() const { return choice_; }
  const Fit& fit() const { return fits_[found_]; }
  std::vector<Candidate>& candidates() { return candidates_; }

  /// Those that fit as well as what was found, but for such as it is a special case of: no data
  /// tell these from it.
  std::vector<Candidate> Alike() const {
    std::vector<Candidate> alike;
    for (std::size_t k = 0; k < candidates_.size(); ++k) {
      const bool close =
          candidates_[k].ln_bayes_factor > candidates_[found_].ln_bayes_factor - kAlike;
      const bool can_be = !candidates_[k].ruled_out && !IsSpecialCaseOf(found_, k);
      if (k != found_ && close && can_be) alike.push_back(candidates_[k]);
    }
    return alike;
  }

 private:
  bool IsSpecialCaseOf(std::size_t special, std::size_t k) const {
    return fitter_.book().IsSpecialCase(candidates_[special].cause, candidates_[k].cause);
  }

  /// Simulates the cause of this name: what that says of it takes the place of what the linear
  /// model says.
  void TryOut(const CauseName& name) {
    const auto tried = std::find_if(
        candidates_.begin(), candidates_.end(),
        [&](const Candidate& one) { return fitter_.book().cause(one.cause).name() == name; });
    if (tried == candidates_.end()) return;
    tried_ = fitter_.WithFaults(With(before_.faults, tried->cause), before_);
    if (!tried_.status.ok()) return;
    tried->ln_guessed = tried_.posterior.ln_evidence - before_.posterior.ln_evidence;
    tried->ln_bayes_factor = tried->ln_guessed;
    SortByEvidence(&candidates_);
  }

  /// Whether to simulate further ones: those that were are none that a robot can have, or explain
  /// little, and the next one promises much.
  bool AreOthersPromising() const {
    const std::size_t next = fits_.size();
    if (next >= candidates_.size() || fitter_.IsOutOfTime()) return false;
    return candidates_[next].ln_bayes_factor >= kClearEvidence &&
           std::all_of(candidates_.begin(), candidates_.begin() + std::ssize(fits_),
                       [](const Candidate& tried) {
                         return tried.ruled_out || tried.ln_bayes_factor < kClearEvidence;
                       });
  }

  /// Of those that were simulated; each is judged once.
  void FindOneThatIsClear(const HeldOut& held_out) {
    for (std::size_t k = 0; k < fits_.size(); ++k) {
      if (!candidates_[k].why_not.empty() || !IsClear(held_out, k)) continue;
      found_ = k;
      return;
    }
  }

  /// Behind those that they are special cases of, as far as these are looked at.
  void PutSpecialCasesNext(std::size_t first, std::size_t end) {
    for (std::size_t k = first; k < end; ++k) {
      for (std::size_t special = k + 1; special < candidates_.size(); ++special) {
        if (!IsSpecialCaseOf(special, k)) continue;
        const auto next = candidates_.begin() + static_cast<std::ptrdiff_t>(k + 1);
        std::rotate(next, candidates_.begin() + static_cast<std::ptrdiff_t>(special),
                    candidates_.begin() + static_cast<std::ptrdiff_t>(special + 1));
      }
    }
  }

  void PreferASpecialCase(const HeldOut& held_out) {
    const double found = candidates_[found_].ln_bayes_factor;
    for (std::size_t k = 0; k < fits_.size(); ++k) {
      if (!IsSpecialCaseOf(k, found_)) continue;
      if (candidates_[k].ln_bayes_factor < found - kClearEvidence) continue;
      const Choice general = choice_;
      const bool clear = IsClear(held_out, k);
      if (clear && candidates_[k].ln_bayes_factor >= found - kClearEvidence) {
        candidates_[found_].why_not = "a simpler cause does nearly as well";
        found_ = k;
        return;
      }
      choice_ = general;
    }
  }

  /// The next ones that were not simulated before.
  void RefineTheBest() {
    const std::size_t first = fits_.size();
    const std::size_t end = std::min(first + kMostRefined, candidates_.size());
    PutSpecialCasesNext(first, end);
    const double least = before_.faults.empty() ? kAlike : kMayGetClear;
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
      best = std::max(best, candidate.ln_bayes_factor);
      fits_.push_back(std::move(fit));
    }
    SortRefined();
    for (std::size_t k = fits_.size(); k-- > 0;) {
      const double behind = candidates_.front().ln_bayes_factor - candidates_[k].ln_bayes_factor;
      // How likely a further one is that cannot get clear, nobody asks.
      if (behind < kAlike && candidates_[k].ln_bayes_factor >= least) Complete(k);
    }
    SortRefined();
  }

  /// The start that fits best after a few rounds becomes the candidate's cause, and goes on.
  Fit RefineFromItsStarts(Candidate* candidate) const {
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
      const bool better = fit.status.ok() && (!best.status.ok() || fit.posterior.ln_evidence >
                                                                       best.posterior.ln_evidence);
      if (!better && !best.faults.empty()) continue;
      candidate->cause = cause;
      best = std::move(fit);
    }
    const bool hopeless = best.posterior.ln_evidence < before_.posterior.ln_evidence;
    if (!best.status.ok() || hopeless) return best;
    return fitter_.Refine(best.faults, best);
  }

  /// With what tolerances do where the fit is, and at the best of its places.
  void Complete(std::size_t k) {
    if (fits_[k].arrived) return;
    const double before = fits_[k].posterior.ln_evidence;
    fits_[k] =
        AtTheBestPlace(fitter_, fitter_.Complete(std::move(fits_[k])), &candidates_[k].cause);
    const double now = fits_[k].posterior.ln_evidence;
    candidates_[k].ln_bayes_factor += fits_[k].status.ok() ? now - before : kImpossible;
  }

  void SortRefined() {
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

  bool IsClear(const HeldOut& before, std::size_t k) {
    Candidate& candidate = candidates_[k];
    if (candidate.ln_bayes_factor >= kClearEvidence) Complete(k);
    if (candidate.ln_bayes_factor < kClearEvidence) {
      candidate.why_not = "the evidence for it is not clear (ln BF " +
                          FormatNumber(std::round(10.0 * candidate.ln_bayes_factor) / 10.0) + ")";
      return false;
    }
    candidate.why_not = WhyNoFault(fitter_.book(), fits_[k].posterior, candidate.cause);
    candidate.ruled_out = !candidate.why_not.empty();
    if (candidate.ruled_out) return false;
    const HeldOut after = LeaveOneOut(fitter_.book(), fits_[k].model, fits_[k].faults);
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

  /// Half of what is believed before is that there is no further cause.
  double Probability(std::size_t k) const {
    const double ln_share = -std::log(static_cast<double>(candidates_.size()));
    double others = std::exp(-candidates_[k].ln_bayes_factor - ln_share);
    for (std::size_t other = 0; other < candidates_.size(); ++other) {
      if (candidates_[other].ruled_out || IsSpecialCaseOf(k, other)) continue;
      others += std::exp(candidates_[other].ln_bayes_factor - candidates_[k].ln_bayes_factor);
    }
    return 1.0 / others;
  }

  /// Whether the robot without the cause fits only far off its tolerances, and with it near them:
  /// it may then predict as well, but no healthy robot does.
  bool KeepsTolerances(std::size_t k) const {
    const std::vector<Eigen::Index> own = fitter_.book().ParametersOf(fits_[k].faults);
    const Belief belief = fitter_.book().BeliefWith({});
    const auto off = [&](const Fit& fit) {
      double sum = 0.0;
      for (Eigen::Index p = 0; p < belief.sigma.size(); ++p) {
        const bool is_own = std::find(own.begin(), own.end(), p) != own.end();
        if (is_own || belief.sigma[p] == 0.0) continue;
        sum += std::pow(fit.posterior.mean[p] / belief.sigma[p], 2);
      }
      return sum;
    };
    return off(before_) - off(fits_[k]) > 2.0 * kClearEvidence;
  }

  /// In how many recordings the fit is clearly better with the cause.
  int SeenIn(std::size_t k) const {
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

  void Explain() {
    const CauseBook& book = fitter_.book();
    const int first = found_ < candidates_.size() ? candidates_[found_].cause : -1;
    for (std::size_t k = 0; k < candidates_.size(); ++k) {
      Candidate& candidate = candidates_[k];
      if (first >= 0 && k != found_) {
        candidate.likeness = Likeness(book, before_.model, first, candidate.cause);
      }
      if (k == found_ || !candidate.why_not.empty()) continue;
      candidate.why_not =
          first >= 0 ? "another cause explains more"
                     : "the evidence for it is not clear (ln BF " +
                           FormatNumber(std::round(10.0 * candidate.ln_bayes_factor) / 10.0) + ")";
    }
  }

  const ObservedExperiment& observed_;
  const Fitter& fitter_;
  const Fit& before_;
  const std::optional<CauseName>& likely_;
  Fit tried_;  ///< with the likely one; or with no faults
  std::vector<Candidate> candidates_;
  std::vector<Fit> fits_;  ///< of the first candidates, that were refined
  std::size_t found_ = static_cast<std::size_t>(-1);
  Choice choice_;
};

/// Whether a cause that fitted as well as one that was named still could stand in its place, now
/// that others are named beside.
bool IsAlike(const Fitter& fitter, const Selection& selection, int cause) {
  const std::vector<int>& faults = selection.best.faults;
  if (std::find(faults.begin(), faults.end(), cause) != faults.end()) return false;
  if (faults.size() < 2) return true;
  return std::any_of(faults.begin(), faults.end(), [&](int named) {
    std::vector<int> others = faults;
    std::replace(others.begin(), others.end(), named, cause);
    return fitter.Guess(selection.best, others).ln_evidence >
           selection.best.posterior.ln_evidence - kAlike;
  });
}

/// How alike the most probable candidates are to each other.
void CompareCandidates(const CauseBook& book, Selection* selection) {
  constexpr std::size_t kMost = 8;
  for (const Candidate& candidate : selection->candidates) {
    if (selection->compared.size() < kMost) selection->compared.push_back(candidate.cause);
  }
  const auto count = std::ssize(selection->compared);
  selection->likeness = Eigen::MatrixXd::Identity(count, count);
  for (Eigen::Index a = 0; a < count; ++a) {
    for (Eigen::Index b = 0; b < a; ++b) {
      const double alike =
          Likeness(book, selection->healthy.model, selection->compared[static_cast<std::size_t>(a)],
                   selection->compared[static_cast<std::size_t>(b)]);
      selection->likeness(a, b) = alike;
      selection->likeness(b, a) = alike;
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
    NextCause next(observed, fitter, selection.best, likely);
    const bool found = next.Look();
    if (number == 0) selection.candidates = next.candidates();
    if (!found) break;
    selection.named.push_back(next.choice());
    for (Candidate& alike : next.Alike()) selection.alike.push_back(alike);
    if (fitter.book().cause(next.choice().cause).BeginsAnew()) {
      selection.best = next.fit();
      break;
    }
    selection.best = seen_again(next.fit());
    if (number > 0) CheckBackward(fitter, kClearEvidence, &selection);
    if (static_cast<int>(selection.named.size()) <= number) break;  // one was dropped for it
  }
  selection.complete = !fitter.IsOutOfTime();  // else fits may have ended early, too
  std::erase_if(selection.alike,
                [&](const Candidate& alike) { return !IsAlike(fitter, selection, alike.cause); });
  report(steps - 1, steps, "looking at what is left");
  if (look_again && !selection.named.empty())
    selection.healthy = fitter.SeenAnew(std::move(selection.healthy));
  selection.guard = Guard(observed, fitter.marker_rest_m(), fitter.book(), selection.best);
  CompareCandidates(fitter.book(), &selection);
  return selection;
}

}  // namespace palpate::diagnosis
