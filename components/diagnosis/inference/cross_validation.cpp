// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/inference/cross_validation.hpp"

#include <algorithm>
#include <cmath>

namespace palpate::diagnosis {

namespace {

/// A larger share rejects faults that help little; the floor avoids a division by zero.
struct CrossValidationTuning {
  double least_share = 0.1;     ///< of the misfit beyond the noise that must go
  double scatter_sigmas = 2.0;  ///< of chi-squared, at least taken for the misfit beyond it
};
constexpr CrossValidationTuning kCrossValidationTuning;

}  // namespace

CrossValidation LeaveOneOut(const HypothesisSet& hypotheses, const LinearModel& model,
                            const std::vector<int>& faults) {
  CrossValidation out;
  out.residual = model.y;
  const Posterior all = hypotheses.InferWithin(model.All(), faults);
  Eigen::Index first = 0;
  for (std::size_t r = 0; r < model.rows_of_recording.size(); ++r) {
    const Eigen::Index rows = model.rows_of_recording[r];
    const Information others = model.AllBut(r);
    const Posterior posterior = hypotheses.InferWithin(others, faults, all.scale);
    const auto J = model.J.middleRows(first, rows);
    auto residual = out.residual.segment(first, rows);
    residual -= J * posterior.mean;
    out.chi_squared.push_back(residual.squaredNorm());
    out.ln_predicted.push_back(all.ln_evidence - posterior.ln_evidence);
    first += rows;
  }
  return out;
}

namespace {

/// Chi-squared beyond the noise of so many rows; at least its scatter.
double Beyond(double chi_squared, Eigen::Index rows) {
  const auto noise = static_cast<double>(rows);
  return std::max(chi_squared - noise,
                  kCrossValidationTuning.scatter_sigmas * std::sqrt(2.0 * noise));
}

}  // namespace

CrossValidationGain Compare(const CrossValidation& before, const CrossValidation& after) {
  CrossValidationGain gain;
  double chi_before = 0.0;
  double chi_after = 0.0;
  for (std::size_t r = 0; r < before.chi_squared.size(); ++r) {
    gain.ln_gain += after.ln_predicted[r] - before.ln_predicted[r];
    chi_before += before.chi_squared[r];
    chi_after += after.chi_squared[r];
  }
  gain.relative = (chi_before - chi_after) / Beyond(chi_before, before.residual.size());
  gain.clear = gain.relative > kCrossValidationTuning.least_share && gain.ln_gain > 0.0;
  return gain;
}

double FittedShare(const Fit& before, const Fit& after) {
  const auto chi_squared = [](const Fit& fit) {
    return (fit.model.y - fit.model.J * fit.posterior.mean).squaredNorm();
  };
  const double chi_before = chi_squared(before);
  return (chi_before - chi_squared(after)) / Beyond(chi_before, before.model.y.size());
}

}  // namespace palpate::diagnosis
