// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "components/diagnosis/inference/cross_validation.hpp"
#include "components/diagnosis/inference/fitter.hpp"
#include "components/diagnosis/inference/hypothesis_set.hpp"

namespace palpate::diagnosis {

/// Thresholds of forward selection and backward elimination. Higher evidence accuses fewer nominal
/// robots and misses more small faults; more refinements cost simulations.
struct SelectionTuning {
  double clear_evidence = 10.0;             ///< least ln BF that a fault must have to be named
  double indistinguishable_evidence = 3.0;  ///< |ln BF| below which faults are not identifiable
  double same_effect = 0.95;        ///< canonical correlation of faults with the same effect
  double least_tolerances = 3.0;    ///< size of a fault that has a tolerance
  double nonzero_sigmas = 2.0;      ///< deviations by which a size differs from zero
  double exactly_screened = 0.0;    ///< ln BF with the discrepancies of before, to infer them again
  double refined_within = 10.0;     ///< ln BF below the best that is still simulated
  double further_promise = 5.0;     ///< ln BF that a further fault promises before that
  std::size_t most_refined = 4;     ///< candidates simulated in a round
  int most_rounds = 2;              ///< rounds of simulated candidates
  std::size_t most_starts = 3;      ///< places of one fault that are simulated
  int rounds_to_compare = 3;        ///< simulations of each before the best goes on
  double least_explained = 0.05;    ///< share of the misfit beyond the noise, fitted or left out
  double seen_chi_squared = 5.0;    ///< half chi-squared by which a recording shows a fault
  double exchange_screened = -8.0;  ///< ln BF of an exchange that counts and may be simulated
  int most_exchanges = 2;           ///< that are simulated for each further fault
};
inline constexpr SelectionTuning kSelectionTuning;

/// A candidate for the next fault, and the result of testing it.
struct Candidate {
  int fault = -1;  ///< the best of those that have its name (places, relaxation times)
  double ln_bayes_factor = 0.0;  ///< against the faults named before; those of one name averaged
  double ln_screened = 0.0;      ///< the same of that one alone, before it was simulated
  double canonical_correlation =
      0.0;                    ///< canonical correlation of its effect with that of the first named
  bool from_nominal = false;  ///< the linear model of the nominal robot promises more
  bool refined = false;       ///< simulated again where it fits best
  std::string why_not = {};   ///< empty: named
  bool ruled_out = false;     ///< where it fits best it is no fault, or more than any robot has
  std::vector<int> starts = {};  ///< faults of its name to simulate, the most probable first
  /// Named fault in the place of which it was simulated, beside all others; -1: it was not.
  int in_place_of = -1;
  double ln_exchanged = 0.0;  ///< what the evidence of all gained by that
};

/// `faults`, and one more.
std::vector<int> With(std::vector<int> faults, int fault);

/// All faults that could be the next beside `faults`, by the linear model of `about`, the most
/// probable first; the best of each name stands for it.
std::vector<Candidate> Screen(const Fitter& fitter, const Fit& about,
                              const std::vector<int>& faults);
/// The most probable first.
void SortByEvidence(std::vector<Candidate>* candidates);

/// Why a fitted fault is not accepted (docs/theory/model_selection.md, Forward selection): it is
/// within tolerances, does not differ from zero, or is not plausible. Empty: it is accepted.
std::string WhyNoFault(const HypothesisSet& hypotheses, const Posterior& posterior, int fault);

/// ln BF within which a rival is not identifiable from the named fault. Where both have the same
/// effect (docs/theory/model_selection.md, Identifiability) their priors decide, not the data:
/// only clear evidence is enough. A special case is different: there the data decide against the
/// further parameters of the named fault.
double IndistinguishableWithin(const HypothesisSet& hypotheses, int named, const Candidate& rival);

/// One fault that was named.
struct Choice {
  int fault = -1;
  double ln_bayes_factor = 0.0;
  double probability = 0.0;  ///< among all candidates and none, with equal priors
  CrossValidationGain cross_validation = {};
  std::vector<double> ln_gain_of_recording = {};  ///< of what was predicted
};

/// Searches for one further fault: screens all by the linear model, simulates the most promising,
/// and takes the best that passes acceptance and cross-validation.
class ForwardSelectionStep {
 public:
  /// All must outlive it. `nominal`: where else faults are fitted from, the nominal robot beside
  /// `before`; nullptr: from nowhere. `clear_evidence`: ln BF that a fault must have to be named.
  ForwardSelectionStep(const ObservedExperiment& observed, const Fitter& fitter, const Fit& before,
                       const Fit* nominal, const std::optional<LikelyFault>& likely,
                       double clear_evidence = kSelectionTuning.clear_evidence)
      : observed_(observed),
        fitter_(fitter),
        before_(before),
        nominal_(nominal),
        likely_(likely),
        clear_evidence_(clear_evidence) {}
  /// Whether there is one; then choice() and fit() are about it.
  bool Search();
  const Choice& choice() const { return choice_; }
  const Fit& fit() const { return fits_[found_]; }
  std::vector<Candidate>& candidates() { return candidates_; }
  /// Candidates that are not identifiable from the one found. Faults of which it is a special case
  /// are left out: they have its effect, and lose evidence by their further parameters only.
  std::vector<Candidate> Indistinguishable() const;

 private:
  bool IsSpecialCaseOf(std::size_t special, std::size_t k) const;
  /// What the linear model of the nominal robot promises, where that is more.
  void ScreenFromTheNominal();
  /// Simulates that fault; the result replaces the evidence of the linear model.
  void SimulateLikely(const LikelyFault& likely);
  /// Whether to simulate a further round: no simulated candidate is acceptable, or the next one
  /// promises more.
  bool AreOthersPromising() const;
  /// Whether one that was not simulated promises clearly more than this one explains.
  bool PromisesAnotherMoreThan(std::size_t k) const;
  /// Of those that were simulated and explain no less than another promises; each is judged once.
  void FindOneThatIsClear(const CrossValidation& cross_validation);
  /// Behind those that they are special cases of, as far as these are evaluated.
  void PutSpecialCasesNext(std::size_t first, std::size_t end);
  /// The next ones that were not simulated before.
  void RefineTheBest();
  /// Of the candidates, all before which were simulated, this one.
  void Refine(std::size_t k);
  /// Far from the nominal robot the linear model says little of what else the same actuator may
  /// have as the `best` of the candidates. Whether there was any that had not been simulated.
  bool RefineThoseAtThePlaceOf(std::size_t best);
  /// What is done to a chamber is far from linear in its pressure; what is done to a cable is not.
  bool IsOfAChamber(const Candidate& candidate) const;
  /// From where more is promised of it; of a chamber from both, the better fit.
  Fit RefineFromItsStarts(Candidate* candidate) const;
  /// Of its starts the one that fits best after a few rounds becomes its fault, and goes on.
  Fit RefineFrom(const Fit& start, Candidate* candidate) const;
  /// With what tolerances do where the fit is, and at the best of its places.
  Fit Completed(Fit fit, Candidate* candidate) const;
  void Complete(std::size_t k);
  /// Those that may be the best once they are complete.
  void CompleteTheBest(double least);
  /// Remembers how wrong the linear model was; not beside a likely fault, where that model is of a
  /// robot far off, and everything else promises too much.
  void LearnFrom(double ln_gain, double ln_surprise);
  void SortRefined();
  bool IsClear(const CrossValidation& before, std::size_t k);
  /// Half of the prior weight is on "no further fault".
  double Probability(std::size_t k) const;
  /// Whether only the hypothesis with the fault keeps the other parameters within tolerances. The
  /// one without it may then predict as well, but is improbable a priori.
  bool KeepsTolerances(std::size_t k) const;
  /// In how many recordings the fit is clearly better with the fault.
  int SeenIn(std::size_t k) const;
  std::string BelowClearEvidence(std::size_t k) const;
  void Explain();

  const ObservedExperiment& observed_;
  const Fitter& fitter_;
  const Fit& before_;
  const Fit* nominal_;
  const std::optional<LikelyFault>& likely_;
  double clear_evidence_;
  Fit tried_;  ///< with the likely one; or with no faults
  std::vector<Candidate> candidates_;
  std::vector<Fit> fits_;   ///< of the first candidates, that were refined
  double ln_gained_ = 0.0;  ///< most that one gained on what the linear model promised
  double ln_error_ = 0.0;   ///< that, or the most that a first step was off
  std::size_t found_ = static_cast<std::size_t>(-1);
  Choice choice_;
};

}  // namespace palpate::diagnosis
