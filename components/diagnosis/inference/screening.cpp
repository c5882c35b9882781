// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/inference/screening.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "libs/linalg/cholesky.hpp"
#include "libs/linalg/qr.hpp"
#include "libs/linalg/svd.hpp"

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
  constexpr std::size_t kMost = 3;
  std::vector<int> starts;
  for (const Candidate& one : of_name) {
    const bool there = std::any_of(starts.begin(), starts.end(), [&](int k) {
      return hypotheses.cause(k).Start() == hypotheses.cause(one.cause).Start();
    });
    if (!there && starts.size() < kMost) starts.push_back(one.cause);
  }
  return starts;
}

}  // namespace

std::vector<int> With(std::vector<int> faults, int cause) {
  faults.push_back(cause);
  return faults;
}

std::vector<Candidate> Screen(const Fitter& fitter, const Fit& about,
                              const std::vector<int>& faults) {
  const HypothesisSet& hypotheses = fitter.hypotheses();
  std::map<std::pair<std::string, std::vector<std::string>>, std::vector<Candidate>> by_name;
  for (int k = 0; k < hypotheses.size(); ++k) {
    const CauseName& name = hypotheses.cause(k).name();
    const bool named = std::any_of(faults.begin(), faults.end(),
                                   [&](int f) { return hypotheses.cause(f).name() == name; });
    if (named || !hypotheses.CanBeFault(k)) continue;
    const double ln_bayes_factor =
        fitter.Guess(about, With(faults, k)).ln_evidence - about.posterior.ln_evidence;
    by_name[{name.id, name.where}].push_back(
        {.cause = k, .ln_bayes_factor = ln_bayes_factor, .ln_guessed = ln_bayes_factor});
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

double CanonicalCorrelation(const HypothesisSet& hypotheses, const LinearModel& model, int a,
                            int b) {
  const GaussianPrior prior = hypotheses.PriorWith({});
  std::vector<Eigen::Index> free;
  for (Eigen::Index p = 0; p < prior.sigma.size(); ++p) {
    const bool own = (p >= hypotheses.first(a) && p < hypotheses.first(a) + hypotheses.count(a)) ||
                     (p >= hypotheses.first(b) && p < hypotheses.first(b) + hypotheses.count(b));
    if (prior.sigma[p] > 0.0 && !own) free.push_back(p);
  }
  const Eigen::VectorXd sigma = prior.sigma(free);
  const Eigen::MatrixXd clutter = model.J(Eigen::all, free) * sigma.asDiagonal();
  Eigen::MatrixXd A = clutter.transpose() * clutter;
  A.diagonal().array() += 1.0;
  const linalg::Cholesky factor(A);
  const auto basis = [&](int k) -> Eigen::MatrixXd {
    Eigen::MatrixXd effect = model.J.middleCols(hypotheses.first(k), hypotheses.count(k));
    effect -= clutter * factor.Solve(Eigen::MatrixXd(clutter.transpose() * effect));
    return linalg::OrthonormalBasis(effect);
  };
  const Eigen::MatrixXd of_a = basis(a);
  const Eigen::MatrixXd of_b = basis(b);
  if (of_a.size() == 0 || of_b.size() == 0) return 0.0;
  return std::min(1.0, linalg::SingularValues(of_a.transpose() * of_b)[0]);
}

}  // namespace palpate::diagnosis
