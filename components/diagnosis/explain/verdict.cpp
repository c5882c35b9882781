// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/explain/verdict.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "components/diagnosis/explain/file_terms.hpp"
#include "components/diagnosis/explain/model_error.hpp"
#include "components/diagnosis/inference/confusability_of_faults.hpp"
#include "components/diagnosis/inference/model_averaging.hpp"

namespace palpate::diagnosis {

namespace {

/// The least probability of an unmodelled cause, in general and where a residual that is not noise
/// has no named cause.
constexpr double kOtherAtLeast = 0.01;
constexpr double kOtherWhereNoneIsNamed = 0.5;

NamedCause Describe(const ObservedExperiment& observed, const Fitter& fitter,
                    const robot::RobotDescription& robot, const Fit& fit,
                    const std::vector<FurtherFault>& further, double other_probability,
                    const Choice& choice) {
  constexpr double kSeen = 1.0;  // of ln p
  const HypothesisSet& hypotheses = fitter.hypotheses();
  const FaultModel& cause = hypotheses.model(choice.fault);
  const Eigen::VectorXd z =
      fit.posterior.mean.segment(hypotheses.first(choice.fault), hypotheses.count(choice.fault));
  const Eigen::MatrixXd covariance = CovarianceOverFurtherFaults(
      hypotheses, fit, choice.fault, further, CovarianceOverPlaces(fitter, fit, choice.fault));
  const Eigen::VectorXd undeformed_m = fitter.HypothesisAt(fit).body.mesh.nodes_m.reshaped();
  NamedCause named{.name = cause.name(),
                   .words = cause.words(),
                   .parameters = cause.Report(z, covariance, undeformed_m),
                   .probability = (1.0 - other_probability) * choice.probability,
                   .ln_bayes_factor = choice.ln_bayes_factor,
                   .cross_validated = choice.cross_validation.clear,
                   .seen_in = {},
                   .in_file = ChangesInFiles(cause, z, covariance, robot)};
  for (std::size_t r = 0; r < choice.ln_gain_of_recording.size(); ++r) {
    if (choice.ln_gain_of_recording[r] > kSeen) {
      named.seen_in.push_back(observed.recordings[r].name);
    }
  }
  return named;
}

/// Of something that the catalogue does not hold, in the place of what is named or where nothing
/// is.
double OtherProbability(const HypothesisSet& hypotheses, const Selection& selection) {
  const bool passed = selection.goodness_of_fit.passed;
  if (selection.named.empty()) return passed ? kOtherAtLeast : kOtherWhereNoneIsNamed;
  return std::max(kOtherAtLeast,
                  ProbabilityOfConfusion(hypotheses, selection.null_model, selection.best, passed));
}

}  // namespace

void DescribeVerdict(const Selection& selection, DiagnosisResult* result) {
  const GoodnessOfFit& goodness_of_fit = selection.goodness_of_fit;
  const std::string left =
      "the residuals are not white (goodness-of-fit test failed: " + goodness_of_fit.worst + ")";
  if (selection.named.empty()) {
    result->verdict = goodness_of_fit.passed ? Verdict::kNoFault : Verdict::kUnexplained;
    result->reason =
        goodness_of_fit.passed
            ? "The residuals are within noise and manufacturing tolerances (null model)."
            : "No fault of the catalogue explains the residuals: " + left + ".";
  } else if (!goodness_of_fit.passed) {
    result->verdict = Verdict::kPartlyExplained;
    result->reason = "The named causes explain part of the residuals; " + left + ".";
  } else if (!selection.indistinguishable.empty()) {
    result->verdict = Verdict::kIndistinguishable;
    result->reason = "The first cause is not identifiable: other faults fit these data as well.";
  } else {
    result->verdict = Verdict::kCause;
    result->reason =
        "With the named causes the residuals are within noise and manufacturing tolerances.";
  }
  result->residual_test = {goodness_of_fit.passed, goodness_of_fit.worst, goodness_of_fit.surprise,
                           goodness_of_fit.surprise_limit, goodness_of_fit.excess};
  result->search_complete = selection.complete;
  if (!selection.complete) {
    result->reason +=
        " The search ended early: not all fits converged, and not all faults were tested.";
  }
}

void DescribeCauses(const ObservedExperiment& observed, const Fitter& fitter,
                    const robot::RobotDescription& robot, const Selection& selection,
                    DiagnosisResult* result) {
  result->other_probability = OtherProbability(fitter.hypotheses(), selection);
  if (selection.named.empty()) return;
  const std::vector<FurtherFault> further = FurtherFaults(fitter, selection.best);
  for (const Choice& choice : selection.named) {
    NamedCause named = Describe(observed, fitter, robot, selection.best, further,
                                result->other_probability, choice);
    named.explained_share = ExplainedShare(fitter.hypotheses(), selection, choice.fault);
    result->causes.push_back(std::move(named));
  }
}

void DescribeRivals(const HypothesisSet& hypotheses, const Selection& selection,
                    DiagnosisResult* result) {
  const auto& candidates = selection.candidates;
  const double ln_share =
      -std::log(static_cast<double>(std::max<std::size_t>(1, candidates.size())));
  std::vector<double> ln_weights{0.0};  // of no fault, then of the candidates
  for (const Candidate& one : candidates) {
    ln_weights.push_back(one.ruled_out ? -std::numeric_limits<double>::infinity()
                                       : one.ln_bayes_factor + ln_share);
  }
  const double ln_most = *std::max_element(ln_weights.begin(), ln_weights.end());
  double all = 0.0;
  for (const double ln_weight : ln_weights) all += std::exp(ln_weight - ln_most);
  const double other = result->other_probability;
  result->no_fault_probability = (1.0 - other) * std::exp(-ln_most) / all;
  for (std::size_t k = 0; k < candidates.size(); ++k) {
    const Candidate& one = candidates[k];
    const bool named = std::any_of(selection.named.begin(), selection.named.end(),
                                   [&](const Choice& choice) { return choice.fault == one.fault; });
    if (named) continue;
    result->rivals.push_back(
        {.name = hypotheses.model(one.fault).name(),
         .words = hypotheses.model(one.fault).words(),
         .probability = (1.0 - other) * std::exp(ln_weights[k + 1] - ln_most) / all,
         .ln_bayes_factor = one.ln_bayes_factor,
         .canonical_correlation = one.canonical_correlation,
         .why_not = one.why_not});
  }
  for (const int cause : selection.compared) {
    result->correlation_names.push_back(hypotheses.model(cause).words());
  }
  result->correlation = selection.canonical_correlation;
  for (const Candidate& one : selection.indistinguishable) {
    result->indistinguishable_from.push_back(hypotheses.model(one.fault).name());
  }
}

}  // namespace palpate::diagnosis
