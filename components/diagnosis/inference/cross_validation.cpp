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
  for (std::size_t r = 0; r < model.of_recording.size(); ++r) {
    const Information& own = model.of_recording[r];
    const Information others = model.AllBut(r);
    const Posterior posterior = hypotheses.InferWithin(others, faults, all.scale);
    const auto J = model.J.middleRows(first, own.rows);
    auto residual = out.residual.segment(first, own.rows);
    residual -= J * posterior.mean;
    out.chi_squared.push_back(residual.squaredNorm());
    out.ln_predicted.push_back(all.ln_evidence - posterior.ln_evidence);
    first += own.rows;
  }
  return out;
}

CrossValidationGain Compare(const CrossValidation& before, const CrossValidation& after) {
  CrossValidationGain gain;
  double chi_before = 0.0;
  double chi_after = 0.0;
  for (std::size_t r = 0; r < before.chi_squared.size(); ++r) {
    gain.ln_gain += after.ln_predicted[r] - before.ln_predicted[r];
    chi_before += before.chi_squared[r];
    chi_after += after.chi_squared[r];
  }
  const double noise = static_cast<double>(before.residual.size());
  const double scatter = kCrossValidationTuning.scatter_sigmas * std::sqrt(2.0 * noise);
  const double beyond = std::max(chi_before - noise, scatter);
  gain.relative = (chi_before - chi_after) / beyond;
  gain.clear = gain.relative > kCrossValidationTuning.least_share && gain.ln_gain > 0.0;
  return gain;
}

}  // namespace palpate::diagnosis
