// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/joined_diagnosis.hpp"

#include <algorithm>
#include <limits>

namespace palpate::diagnosis {

namespace {

/// Squares beyond the noise, as a robot within its tolerances leaves them; m^2 times samples.
double Excess(const std::vector<RecordingError>& recordings) {
  double sum = 0.0;
  for (const RecordingError& one : recordings) {
    const double excess_m2 = one.null_model_m * one.null_model_m - one.noise_m * one.noise_m;
    if (excess_m2 > 0.0) sum += one.samples * excess_m2;
  }
  return sum;
}

/// The model error was there as the robot file has it.
void PutBefore(const DiagnosisResult& of_file, DiagnosisResult* result) {
  result->model_error.before_m = of_file.model_error.before_m;
  ErrorSummary& error = result->model_error;
  error.null_model_m = of_file.model_error.null_model_m;
  error.heldout_before_m = of_file.model_error.heldout_before_m;
  // The finer mesh's own gain is not that of both.
  error.heldout_gain_low_m = std::numeric_limits<double>::quiet_NaN();
  error.heldout_gain_high_m = error.heldout_gain_low_m;
  for (std::size_t r = 0; r < result->recordings.size(); ++r) {
    result->recordings[r].before_m = of_file.recordings[r].before_m;
    result->recordings[r].null_model_m = of_file.recordings[r].null_model_m;
    result->recordings[r].heldout_before_m = of_file.recordings[r].heldout_before_m;
  }
  for (ComparedSample& compared : result->compared_samples) {
    for (const ComparedSample& before : of_file.compared_samples) {
      const bool same = before.recording == compared.recording && before.t_s == compared.t_s;
      if (same && before.before_m.cols() == compared.before_m.cols())
        compared.before_m = before.before_m;
    }
  }
}

bool IsNamed(const CauseName& name, const DiagnosisResult& result) {
  return std::any_of(result.causes.begin(), result.causes.end(),
                     [&](const NamedCause& named) { return named.name == name; });
}

}  // namespace

Diagnosis Joined(Diagnosis of_file, Diagnosis of_finer) {
  const DiagnosisResult& before = of_file.result;
  DiagnosisResult& result = of_finer.result;
  if (result.verdict == Verdict::kDataUnfit || result.interrupted) {
    of_file.result.reason += " The finer mesh gave no diagnosis: " + result.reason + ".";
    of_file.result.search_complete = false;
    of_file.result.interrupted = result.interrupted;
    return of_file;
  }
  const double excess = Excess(before.recordings);
  const double left = excess > 0.0 ? std::min(1.0, Excess(result.recordings) / excess) : 1.0;
  for (NamedCause& cause : result.causes) cause.explained_share *= left;
  result.causes.insert(result.causes.begin(), before.causes.back());
  result.causes.front().explained_share = 1.0 - left;
  if (result.verdict == Verdict::kNoFault) {
    result.verdict = Verdict::kCause;
    result.reason = "On a finer mesh the residuals are within noise and manufacturing tolerances.";
  }
  if (result.verdict == Verdict::kUnexplained) result.verdict = Verdict::kPartlyExplained;
  result.rivals = before.rivals;
  std::erase_if(result.rivals, [&](const Rival& one) { return IsNamed(one.name, result); });
  result.no_fault_probability = before.no_fault_probability;
  result.correlation_names = before.correlation_names;
  result.correlation = before.correlation;
  PutBefore(before, &result);
  return of_finer;
}

}  // namespace palpate::diagnosis
