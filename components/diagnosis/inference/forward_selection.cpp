// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/inference/forward_selection.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <vector>

#include "components/diagnosis/inference/canonical_correlation.hpp"
#include "components/diagnosis/inference/linear_comparison.hpp"
#include "components/diagnosis/inference/model_averaging.hpp"
#include "libs/core/index.hpp"
#include "libs/core/text.hpp"
#include "libs/linalg/cholesky.hpp"

namespace palpate::diagnosis {

namespace {

/// ln of the mean of exp.
double LogMeanExp(const std::vector<double>& values) {
  const double most = *std::max_element(values.begin(), values.end());
  double sum = 0.0;
  for (const double value : values) sum += std::exp(value - most);
  return most + std::log(sum / static_cast<double>(values.size()));
}

/// Which of one name to simulate; `of_name`: the most probable first.
std::vector<int> StartsOf(const HypothesisSet& hypotheses, const std::vector<Candidate>& of_name) {
  std::vector<int> starts;
  for (const Candidate& one : of_name) {
    const bool there = std::any_of(starts.begin(), starts.end(), [&](int k) {
      return hypotheses.model(k).Start() == hypotheses.model(one.fault).Start();
    });
    if (!there && starts.size() < kSelectionTuning.most_starts) starts.push_back(one.fault);
  }
  return starts;
}

}  // namespace

std::vector<int> With(std::vector<int> faults, int fault) {
  faults.push_back(fault);
  return faults;
}

std::vector<Candidate> Screen(const Fitter& fitter, const Fit& about,
                              const std::vector<int>& faults) {
  const HypothesisSet& hypotheses = fitter.hypotheses();
  const Information& data = about.model.All();
  const Posterior base = hypotheses.InferWithin(data, faults, about.posterior.scale);
  const Eigen::VectorXd at_first =
      LinearComparison(hypotheses, data.H, base.prior).LnBayesFactors(data.b);
  std::map<std::pair<std::string, std::vector<std::string>>, std::vector<Candidate>> by_name;
  for (int k = 0; k < hypotheses.size(); ++k) {
    const CauseName& name = hypotheses.model(k).name();
    const bool named = std::any_of(faults.begin(), faults.end(),
                                   [&](int f) { return hypotheses.model(f).name() == name; });
    if (named || !hypotheses.CanBeFault(k)) continue;
    double ln_bayes_factor = at_first[k];
    // With a fault that is there the discrepancies are smaller than without it.
    if (ln_bayes_factor > kSelectionTuning.exactly_screened) {
      ln_bayes_factor =
          hypotheses.InferWithin(data, With(faults, k)).ln_evidence - about.posterior.ln_evidence;
    }
    by_name[{name.id, name.where}].push_back(
        {.fault = k, .ln_bayes_factor = ln_bayes_factor, .ln_screened = ln_bayes_factor});
  }
  std::vector<Candidate> candidates;
  for (auto& [name, of_name] : by_name) {
    std::stable_sort(of_name.begin(), of_name.end(), [](const auto& a, const auto& b) {
      return a.ln_bayes_factor > b.ln_bayes_factor;
    });
    std::vector<double> values;
    for (const Candidate& one : of_name) values.push_back(one.ln_bayes_factor);
    Candidate best = of_name.front();
    best.ln_bayes_factor = LogMeanExp(values);
    best.starts = StartsOf(hypotheses, of_name);
    candidates.push_back(std::move(best));
  }
  SortByEvidence(&candidates);
  return candidates;
}

void SortByEvidence(std::vector<Candidate>* candidates) {
  std::sort(candidates->begin(), candidates->end(),
            [](const auto& a, const auto& b) { return a.ln_bayes_factor > b.ln_bayes_factor; });
}

namespace {

/// By how many sigmas the data exclude a nominal robot, of a fault with sizes that begin at nothing
/// beside such as a nominal robot may have: of these the likeliest where the others are nothing. 0:
/// it has none of them. Data may tell the sum of a delay and a time constant, and neither of them.
double SigmasFromNominal(const HypothesisSet& hypotheses, const Posterior& posterior, int fault) {
  std::vector<Eigen::Index> tolerated;
  std::vector<double> tolerance;
  std::vector<Eigen::Index> others;
  for (Eigen::Index p = 0; p < hypotheses.count(fault); ++p) {
    const Eigen::Index column = hypotheses.first(fault) + p;
    const FaultParameter& parameter = hypotheses.model(fault).parameters()[At(p)];
    if (!(posterior.covariance(column, column) > 0.0)) continue;  // it is at its bound
    if (const double own = hypotheses.ToleranceOf(fault, static_cast<int>(p)); own > 0.0) {
      tolerated.push_back(column);
      tolerance.push_back(own);
    } else if (parameter.scale == FaultParameter::Scale::kLinear && parameter.least == 0.0) {
      others.push_back(column);
    }
  }
  if (others.empty()) return 0.0;
  const Eigen::MatrixXd& covariance = posterior.covariance;
  const Eigen::VectorXd gone = posterior.mean(others);
  const Eigen::VectorXd reach = kSelectionTuning.least_tolerances *
                                Eigen::VectorXd::Map(tolerance.data(), std::ssize(tolerance));
  const Eigen::MatrixXd covariance_of_others = covariance(others, others);
  const Eigen::MatrixXd both = covariance(tolerated, others);
  const Eigen::VectorXd likeliest =
      posterior.mean(tolerated) - both * linalg::SolveSymmetric(covariance_of_others, gone);
  Eigen::VectorXd off(std::ssize(tolerated) + std::ssize(others));
  off << posterior.mean(tolerated) - likeliest.cwiseMax(-reach).cwiseMin(reach), gone;
  std::vector<Eigen::Index> all = tolerated;
  all.insert(all.end(), others.begin(), others.end());
  const Eigen::MatrixXd covariance_of_all = covariance(all, all);
  return std::sqrt(off.dot(linalg::SolveSymmetric(covariance_of_all, off)));
}

/// How many of its tolerances a fault is away from the robot file; infinite for one that a nominal
/// robot has nothing of, of which the evidence says all.
double SizeInTolerances(const HypothesisSet& hypotheses, const Posterior& posterior, int fault) {
  double most = -1.0;
  double squares = 0.0;
  int components = 0;
  for (Eigen::Index p = 0; p < hypotheses.count(fault); ++p) {
    const double tolerance = hypotheses.ToleranceOf(fault, static_cast<int>(p));
    if (tolerance <= 0.0) continue;
    const double size = std::abs(posterior.mean[hypotheses.first(fault) + p]) / tolerance;
    if (hypotheses.model(fault).parameters()[At(p)].component) {
      squares += size * size;
      ++components;
    } else {
      most = std::max(most, size);
    }
  }
  // The tolerance of a vector's length is by that root more than that of each of its components.
  if (components > 0) most = std::max(most, std::sqrt(squares / components));
  const bool beyond =
      SigmasFromNominal(hypotheses, posterior, fault) > kSelectionTuning.least_tolerances;
  return most < 0.0 || beyond ? std::numeric_limits<double>::infinity() : most;
}

/// Whether what is known of how large it is does not exclude that there is nothing of it. Evidence
/// for such a one is of fits that did not come to their ends. An obstacle that nearly touches is
/// one. What qualifies a size, as the time constant of a creep does, is held at its estimate: where
/// the size is zero it has no effect, though the data may tell the two together and neither alone.
bool MayBeNothing(const HypothesisSet& hypotheses, const Posterior& posterior, int fault) {
  if (hypotheses.model(fault).Start()) return false;
  std::vector<Eigen::Index> sizes;
  std::vector<Eigen::Index> qualifiers;
  for (Eigen::Index p = 0; p < hypotheses.count(fault); ++p) {
    const Eigen::Index column = hypotheses.first(fault) + p;
    if (!(posterior.covariance(column, column) > 0.0)) continue;  // it is at its bound
    const bool qualifies = hypotheses.model(fault).parameters()[At(p)].qualifies;
    (qualifies ? qualifiers : sizes).push_back(column);
  }
  if (sizes.empty()) return false;
  const Eigen::VectorXd z = posterior.mean(sizes);
  Eigen::MatrixXd covariance = posterior.covariance(sizes, sizes);
  if (!qualifiers.empty()) {
    const Eigen::MatrixXd of_qualifiers = posterior.covariance(qualifiers, qualifiers);
    const Eigen::MatrixXd both = posterior.covariance(qualifiers, sizes);
    covariance -= both.transpose() * linalg::SolveSymmetric(of_qualifiers, both);
  }
  return z.dot(linalg::SolveSymmetric(covariance, z)) < kSelectionTuning.nonzero_sigmas *
                                                            kSelectionTuning.nonzero_sigmas *
                                                            static_cast<double>(sizes.size());
}

}  // namespace

std::string WhyNoFault(const HypothesisSet& hypotheses, const Posterior& posterior, int fault) {
  if (SizeInTolerances(hypotheses, posterior, fault) < kSelectionTuning.least_tolerances) {
    return "it is within three manufacturing tolerances of the nominal robot";
  }
  if (MayBeNothing(hypotheses, posterior, fault)) {
    return "its size does not differ from zero by two standard deviations";
  }
  for (Eigen::Index p = 0; p < hypotheses.count(fault); ++p) {
    const FaultParameter& parameter = hypotheses.model(fault).parameters()[At(p)];
    const double z = posterior.mean[hypotheses.first(fault) + p];
    if (std::abs(z) <= parameter.plausible) continue;
    return "its value is not plausible (" + parameter.name + " = " +
           FormatNumber(parameter.ValueOf(z)) + "): another fault has this effect";
  }
  return {};
}

namespace {

constexpr double kImpossible = -1e9;  ///< ln BF of what cannot be simulated

}  // namespace

double IndistinguishableWithin(const HypothesisSet& hypotheses, int named, const Candidate& rival) {
  const bool same = rival.canonical_correlation > kSelectionTuning.same_effect &&
                    !hypotheses.IsSpecialCase(rival.fault, named);
  return same ? kSelectionTuning.clear_evidence : kSelectionTuning.indistinguishable_evidence;
}

bool ForwardSelectionStep::Search() {
  candidates_ = Screen(fitter_, before_, before_.faults);
  if (nominal_ != nullptr) ScreenFromTheNominal();
  if (likely_) SimulateLikely(*likely_);
  if (candidates_.empty() ||
      candidates_.front().ln_bayes_factor < kSelectionTuning.indistinguishable_evidence) {
    Explain();
    return false;
  }
  const CrossValidation cross_validation =
      LeaveOneOut(fitter_.hypotheses(), before_.model, before_.faults);
  for (int round = 0; round < kSelectionTuning.most_rounds && found_ >= candidates_.size();
       ++round) {
    if (round > 0 && !AreOthersPromising()) break;
    RefineTheBest();
    FindOneThatIsClear(cross_validation);
  }
  const std::size_t best = found_ < candidates_.size() ? found_ : 0;
  const bool is_open =
      candidates_[best].ln_bayes_factor >= kSelectionTuning.indistinguishable_evidence;
  if (nominal_ != nullptr && is_open && IsOfAChamber(candidates_[best]) &&
      RefineThoseAtThePlaceOf(best)) {
    found_ = candidates_.size();
    FindOneThatIsClear(cross_validation);
  }
  Explain();
  return found_ < candidates_.size();
}

std::vector<Candidate> ForwardSelectionStep::Indistinguishable() const {
  std::vector<Candidate> indistinguishable;
  for (std::size_t k = 0; k < candidates_.size(); ++k) {
    const Candidate& rival = candidates_[k];
    const double behind = candidates_[found_].ln_bayes_factor - rival.ln_bayes_factor;
    if (k == found_ || rival.ruled_out || IsSpecialCaseOf(found_, k)) continue;
    const double within =
        IndistinguishableWithin(fitter_.hypotheses(), candidates_[found_].fault, rival);
    if (behind < within) indistinguishable.push_back(rival);
  }
  return indistinguishable;
}

bool ForwardSelectionStep::IsSpecialCaseOf(std::size_t special, std::size_t k) const {
  return fitter_.hypotheses().IsSpecialCase(candidates_[special].fault, candidates_[k].fault);
}

void ForwardSelectionStep::ScreenFromTheNominal() {
  const HypothesisSet& hypotheses = fitter_.hypotheses();
  // Where the null model does not keep what its linear model promises, no fault may profit by that.
  const double ln_behind =
      std::max(0.0, before_.posterior.ln_evidence - nominal_->posterior.ln_evidence);
  for (Candidate& there : Screen(fitter_, *nominal_, before_.faults)) {
    there.ln_bayes_factor -= ln_behind;
    there.ln_screened -= ln_behind;
    const auto here = std::find_if(candidates_.begin(), candidates_.end(), [&](const auto& one) {
      return hypotheses.model(one.fault).name() == hypotheses.model(there.fault).name();
    });
    there.from_nominal = true;
    if (here != candidates_.end() && here->ln_bayes_factor < there.ln_bayes_factor)
      *here = std::move(there);
  }
  SortByEvidence(&candidates_);
}

void ForwardSelectionStep::SimulateLikely(const LikelyFault& likely) {
  const HypothesisSet& hypotheses = fitter_.hypotheses();
  const auto tried = std::find_if(
      candidates_.begin(), candidates_.end(),
      [&](const Candidate& one) { return hypotheses.model(one.fault).name() == likely.name; });
  if (tried == candidates_.end()) return;
  for (int k = 0; k < hypotheses.size() && likely.start; ++k) {
    if (!likely.Is(hypotheses.model(k))) continue;
    tried->fault = k;
    tried->starts = {k};
  }
  tried_ = fitter_.WithFaults(With(before_.faults, tried->fault), before_);
  // There the tolerances are those of the robot file, far from their best.
  if (tried_.status.ok()) tried_ = fitter_.Complete(fitter_.Refine(tried_.faults, tried_));
  if (!tried_.status.ok()) return;
  tried->ln_screened = tried_.posterior.ln_evidence - before_.posterior.ln_evidence;
  tried->ln_bayes_factor = tried->ln_screened;
  SortByEvidence(&candidates_);
}

bool ForwardSelectionStep::AreOthersPromising() const {
  const std::size_t next = fits_.size();
  if (next >= candidates_.size() || fitter_.IsOutOfTime()) return false;
  if (candidates_[next].ln_bayes_factor + ln_gained_ < clear_evidence_) return false;
  for (std::size_t k = 0; k < fits_.size(); ++k) {
    const Candidate& tried = candidates_[k];
    const bool can_be = !tried.ruled_out && tried.ln_bayes_factor >= clear_evidence_;
    if (can_be && !PromisesAnotherMoreThan(k)) return false;
  }
  return true;
}

bool ForwardSelectionStep::PromisesAnotherMoreThan(std::size_t k) const {
  const std::size_t next = fits_.size();
  return next < candidates_.size() &&
         candidates_[next].ln_bayes_factor >
             candidates_[k].ln_bayes_factor + kSelectionTuning.refined_within;
}

void ForwardSelectionStep::FindOneThatIsClear(const CrossValidation& cross_validation) {
  for (std::size_t k = 0; k < fits_.size(); ++k) {
    if (!candidates_[k].why_not.empty() || PromisesAnotherMoreThan(k)) continue;
    if (!IsClear(cross_validation, k)) continue;
    found_ = k;
    return;
  }
}

void ForwardSelectionStep::PutSpecialCasesNext(std::size_t first, std::size_t end) {
  for (std::size_t k = first; k < end; ++k) {
    for (std::size_t special = k + 1; special < candidates_.size(); ++special) {
      if (!IsSpecialCaseOf(special, k)) continue;
      const auto next = candidates_.begin() + ToIndex(k + 1);
      std::rotate(next, candidates_.begin() + ToIndex(special),
                  candidates_.begin() + ToIndex(special + 1));
    }
  }
}

void ForwardSelectionStep::RefineTheBest() {
  const std::size_t first = fits_.size();
  const std::size_t end = std::min(first + kSelectionTuning.most_refined, candidates_.size());
  PutSpecialCasesNext(first, end);
  const double least = before_.faults.empty() ? kSelectionTuning.indistinguishable_evidence
                                              : kSelectionTuning.further_promise;
  double best = -std::numeric_limits<double>::infinity();
  bool last = false;
  for (std::size_t k = first; k < end && !last; ++k) {
    Candidate& candidate = candidates_[k];
    const bool special = k > first && IsSpecialCaseOf(k, k - 1);
    if (!special) {
      const double reach = std::max(kSelectionTuning.refined_within, ln_error_);
      if (candidate.ln_bayes_factor < std::max(least, best - reach)) break;
      // One more where the linear model was so wrong about the others.
      last = candidate.ln_bayes_factor < best - kSelectionTuning.refined_within;
    }
    if (k > 0 && fitter_.IsOutOfTime()) break;
    Refine(k);
    best = std::max(best, std::min(candidate.ln_screened, candidate.ln_bayes_factor));
  }
  SortRefined();
  CompleteTheBest(least);
  SortRefined();
}

void ForwardSelectionStep::Refine(std::size_t k) {
  Candidate& candidate = candidates_[k];
  Fit fit = RefineFromItsStarts(&candidate);
  const double now = fit.posterior.ln_evidence - before_.posterior.ln_evidence;
  candidate.ln_bayes_factor += fit.status.ok() ? now - candidate.ln_screened : kImpossible;
  candidate.refined = true;
  // Where one gains on what was guessed of it, another may, too.
  if (fit.status.ok()) LearnFrom(now - candidate.ln_screened, fit.ln_surprise);
  fits_.push_back(std::move(fit));
}

bool ForwardSelectionStep::RefineThoseAtThePlaceOf(std::size_t best) {
  const HypothesisSet& hypotheses = fitter_.hypotheses();
  const std::vector<std::string> where = hypotheses.model(candidates_[best].fault).name().where;
  // What restarts the search was tested before the fit.
  const auto is_there = [&](const Candidate& one) {
    const FaultModel& model = hypotheses.model(one.fault);
    return model.name().where == where && !model.RestartsSearch();
  };
  const std::size_t first = fits_.size();
  std::stable_partition(candidates_.begin() + ToIndex(first), candidates_.end(), is_there);
  for (std::size_t k = first; k < candidates_.size() && is_there(candidates_[k]); ++k) {
    if (fitter_.IsOutOfTime()) break;
    Refine(k);
  }
  SortRefined();
  return fits_.size() > first;
}

/// Out of time, only what may be named is completed (IsClear). A further fault that cannot reach
/// the least evidence needs no probability.
void ForwardSelectionStep::CompleteTheBest(double least) {
  const double front = candidates_.front().ln_bayes_factor;
  double within = kSelectionTuning.indistinguishable_evidence;
  for (std::size_t k = 0; k < fits_.size() && !fitter_.IsOutOfTime(); ++k) {
    const double before = candidates_[k].ln_bayes_factor;
    if (before < least || front - before >= within) continue;
    Complete(k);
    // What completing one gains, it may gain of another, too.
    if (!likely_) within = std::max(within, candidates_[k].ln_bayes_factor - before);
  }
}

bool ForwardSelectionStep::IsOfAChamber(const Candidate& candidate) const {
  const std::vector<std::string>& where = fitter_.hypotheses().model(candidate.fault).name().where;
  return std::any_of(where.begin(), where.end(),
                     [](const std::string& one) { return one.starts_with("chamber:"); });
}

Fit ForwardSelectionStep::RefineFromItsStarts(Candidate* candidate) const {
  if (!IsOfAChamber(*candidate) || nominal_ == nullptr || fitter_.IsOutOfTime())
    return RefineFrom(candidate->from_nominal ? *nominal_ : before_, candidate);
  Fit here = RefineFrom(before_, candidate);
  // About either place the effect is another one, and so are the parts of samples: only complete
  // fits compare.
  Candidate from_there = *candidate;
  Fit there = Completed(RefineFrom(*nominal_, &from_there), &from_there);
  here = Completed(std::move(here), candidate);
  const bool better = there.status.ok() && (!here.status.ok() || there.posterior.ln_evidence >
                                                                     here.posterior.ln_evidence);
  if (!better) return here;
  candidate->fault = from_there.fault;
  return there;
}

Fit ForwardSelectionStep::RefineFrom(const Fit& start, Candidate* candidate) const {
  if (candidate->starts.size() < 2) {
    const std::vector<int> faults = With(before_.faults, candidate->fault);
    const bool was_tried = tried_.status.ok() && tried_.faults == faults;
    return fitter_.Refine(faults, was_tried ? tried_ : start);
  }
  Fit best;
  for (const int fault : candidate->starts) {
    if (!best.faults.empty() && fitter_.IsOutOfTime()) break;
    Fit fit = fitter_.Refine(With(before_.faults, fault), start, kSelectionTuning.rounds_to_compare,
                             Detail::kMiddles);
    const bool better = fit.status.ok() && (!best.status.ok() ||
                                            fit.posterior.ln_evidence > best.posterior.ln_evidence);
    if (!better && !best.faults.empty()) continue;
    candidate->fault = fault;
    best = std::move(fit);
  }
  const bool hopeless = best.posterior.ln_evidence < before_.posterior.ln_evidence;
  if (!best.status.ok() || hopeless) return best;
  return fitter_.Refine(best.faults, best);
}

Fit ForwardSelectionStep::Completed(Fit fit, Candidate* candidate) const {
  return AtTheBestPlace(fitter_, fitter_.Complete(std::move(fit)), &candidate->fault);
}

void ForwardSelectionStep::Complete(std::size_t k) {
  if (fits_[k].arrived) return;
  const double before = fits_[k].posterior.ln_evidence;
  fits_[k] = Completed(std::move(fits_[k]), &candidates_[k]);
  const double now = fits_[k].posterior.ln_evidence;
  candidates_[k].ln_bayes_factor += fits_[k].status.ok() ? now - before : kImpossible;
  const double ln_gain = now - before_.posterior.ln_evidence - candidates_[k].ln_screened;
  if (fits_[k].status.ok()) LearnFrom(ln_gain, fits_[k].ln_surprise);
}

void ForwardSelectionStep::LearnFrom(double ln_gain, double ln_surprise) {
  if (likely_) return;
  ln_gained_ = std::max(ln_gained_, ln_gain);
  ln_error_ = std::max({ln_error_, ln_gain, ln_surprise});
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
  if (candidate.ln_bayes_factor >= clear_evidence_) Complete(k);
  if (candidate.ln_bayes_factor < clear_evidence_) {
    candidate.why_not = BelowClearEvidence(k);
    return false;
  }
  candidate.why_not = WhyNoFault(fitter_.hypotheses(), fits_[k].posterior, candidate.fault);
  candidate.ruled_out = !candidate.why_not.empty();
  if (candidate.ruled_out) return false;
  const CrossValidation after = LeaveOneOut(fitter_.hypotheses(), fits_[k].model, fits_[k].faults);
  Choice choice{.fault = candidate.fault, .ln_bayes_factor = candidate.ln_bayes_factor};
  choice.cross_validation = Compare(before, after);
  for (std::size_t r = 0; r < after.ln_predicted.size(); ++r) {
    choice.ln_gain_of_recording.push_back(after.ln_predicted[r] - before.ln_predicted[r]);
  }
  if (!choice.cross_validation.clear && SeenIn(k) > 1 && !KeepsTolerances(k)) {
    candidate.why_not = "left-out recordings are predicted no better with it (ln BF " +
                        FormatNumber(std::round(10.0 * choice.cross_validation.ln_gain) / 10.0) +
                        ", " + FormatNumber(std::round(100.0 * choice.cross_validation.relative)) +
                        " % of the error beyond the noise)";
    return false;
  }
  const double explained =
      std::max(choice.cross_validation.relative, FittedShare(before_, fits_[k]));
  if (explained < kSelectionTuning.least_explained) {
    candidate.why_not = "it explains next to nothing of the error beyond the noise (" +
                        FormatNumber(std::round(100.0 * explained)) + " %)";
    return false;
  }
  choice.probability = Probability(k);
  choice_ = std::move(choice);
  return true;
}

std::string ForwardSelectionStep::BelowClearEvidence(std::size_t k) const {
  const auto rounded = [](double value) { return FormatNumber(std::round(10.0 * value) / 10.0); };
  return "the evidence for it is below ln BF " + rounded(clear_evidence_) + " (ln BF " +
         rounded(candidates_[k].ln_bayes_factor) + ")";
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
  return off(before_) - off(fits_[k]) > 2.0 * kSelectionTuning.clear_evidence;
}

int ForwardSelectionStep::SeenIn(std::size_t k) const {
  int recordings = 0;
  Eigen::Index first = 0;
  Eigen::Index first_before = 0;
  for (std::size_t r = 0; r < observed_.recordings.size(); ++r) {
    const auto misfit = [&](const Fit& fit, Eigen::Index begin) {
      const Eigen::Index rows = fit.model.rows_of_recording[r];
      return (fit.model.y.segment(begin, rows) -
              fit.model.J.middleRows(begin, rows) * fit.posterior.mean)
          .squaredNorm();
    };
    const double gain = 0.5 * (misfit(before_, first_before) - misfit(fits_[k], first));
    if (gain > kSelectionTuning.seen_chi_squared) ++recordings;
    first += fits_[k].model.rows_of_recording[r];
    first_before += before_.model.rows_of_recording[r];
  }
  return recordings;
}

void ForwardSelectionStep::Explain() {
  const HypothesisSet& hypotheses = fitter_.hypotheses();
  const int first = found_ < candidates_.size() ? candidates_[found_].fault : -1;
  const Information& data = before_.model.All();
  for (std::size_t k = 0; k < candidates_.size(); ++k) {
    Candidate& candidate = candidates_[k];
    if (first >= 0 && k != found_) {
      candidate.canonical_correlation =
          CanonicalCorrelation(hypotheses, data, before_.posterior.scale, first, candidate.fault);
    }
    if (k == found_ || !candidate.why_not.empty()) continue;
    if (k < fits_.size() && PromisesAnotherMoreThan(k)) {
      candidate.why_not = "another fault that promises more was not simulated";
    } else if (first >= 0) {
      candidate.why_not = "another fault explains more";
    } else if (!candidate.refined && candidate.ln_bayes_factor >= clear_evidence_) {
      candidate.why_not = "it was not simulated: a fault that promised more was not accepted";
    } else {
      candidate.why_not = BelowClearEvidence(k);
    }
  }
}

}  // namespace palpate::diagnosis
