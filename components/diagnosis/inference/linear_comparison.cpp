// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/inference/linear_comparison.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "libs/core/index.hpp"
#include "libs/linalg/cholesky.hpp"

namespace palpate::diagnosis {

LinearComparison::LinearComparison(const HypothesisSet& hypotheses, const Eigen::MatrixXd& H,
                                   GaussianPrior base)
    : hypotheses_(hypotheses), base_(std::move(base)), b_of_mean_(H * base_.mean) {
  for (Eigen::Index p = 0; p < base_.sigma.size(); ++p) {
    if (base_.sigma[p] > 0.0) free_.push_back(p);
  }
  const Eigen::VectorXd sigma = base_.sigma(free_);
  const Eigen::MatrixXd D_H = sigma.asDiagonal() * H(free_, Eigen::all);
  Eigen::MatrixXd A = D_H(Eigen::all, free_) * sigma.asDiagonal();
  A.diagonal().array() += 1.0;
  const Eigen::MatrixXd solved = linalg::Cholesky(A).Solve(D_H);
  H_ = H - D_H.transpose() * solved;
  from_b_ = solved.transpose() * sigma.asDiagonal();
  for (int k = 0; k < hypotheses.size(); ++k) {
    of_fault_.push_back(hypotheses.CanBeFault(k) ? OwnOf(k) : Own{});
  }
}

LinearComparison::Own LinearComparison::OwnOf(int fault) const {
  const std::vector<Eigen::Index> own = hypotheses_.ParametersOf({fault});
  Own known;
  known.H = H_(own, own);
  known.of_b = Eigen::MatrixXd::Zero(std::ssize(own), H_.cols());
  for (std::size_t k = 0; k < own.size(); ++k) known.of_b(ToIndex(k), own[k]) = 1.0;
  known.of_b(Eigen::all, free_) -= from_b_(own, Eigen::all);
  std::vector<Eigen::Index> tolerated;
  for (std::size_t k = 0; k < own.size(); ++k) {
    if (base_.sigma[own[k]] > 0.0) tolerated.push_back(ToIndex(k));
  }
  if (tolerated.empty()) return known;
  const Eigen::MatrixXd cross = known.H(tolerated, Eigen::all);
  Eigen::MatrixXd left = -known.H(tolerated, tolerated);
  for (std::size_t k = 0; k < tolerated.size(); ++k) {
    const double sigma = base_.sigma[own[At(tolerated[k])]];
    left(ToIndex(k), ToIndex(k)) += 1.0 / (sigma * sigma);
  }
  const Eigen::MatrixXd back = linalg::SolveSymmetric(left, cross).transpose();
  const Eigen::MatrixXd of_tolerated = known.of_b(tolerated, Eigen::all);
  known.H += back * cross;
  known.of_b += back * of_tolerated;
  return known;
}

double LinearComparison::LnBayesFactor(int fault, const Eigen::VectorXd& b,
                                       Eigen::VectorXd* mean) const {
  const Own& own = of_fault_[At(fault)];
  const Eigen::Index count = hypotheses_.count(fault);
  const Eigen::Index first = hypotheses_.first(fault);
  Information data(count);
  data.H = own.H;
  data.b = own.of_b * (b - b_of_mean_);
  GaussianPrior without(count);
  GaussianPrior with(count);
  for (Eigen::Index p = 0; p < count; ++p) {
    const FaultParameter& parameter = hypotheses_.model(fault).parameters()[At(p)];
    without.sigma[p] = base_.sigma[first + p];
    with.sigma[p] = std::max(parameter.fault, without.sigma[p]);
    with.mean[p] = parameter.fault_at - base_.mean[first + p];
  }
  Posterior posterior = Infer(data, with);
  for (Eigen::Index p = 0; p < count; ++p) {  // those that leave their range, one after the other
    const FaultParameter& parameter = hypotheses_.model(fault).parameters()[At(p)];
    const double from = base_.mean[first + p];
    const double bounded =
        std::clamp(posterior.mean[p], parameter.least - from, parameter.most - from);
    if (bounded == posterior.mean[p]) continue;
    with.mean[p] = bounded;
    with.sigma[p] = 0.0;
    posterior = Infer(data, with);
  }
  if (mean != nullptr) *mean = posterior.mean + base_.mean.segment(first, count);
  return posterior.ln_evidence - Infer(data, without).ln_evidence;
}

Eigen::VectorXd LinearComparison::LnBayesFactors(const Eigen::VectorXd& b) const {
  Eigen::VectorXd all =
      Eigen::VectorXd::Constant(hypotheses_.size(), -std::numeric_limits<double>::infinity());
  for (int k = 0; k < hypotheses_.size(); ++k) {
    if (hypotheses_.CanBeFault(k)) all[k] = LnBayesFactor(k, b, nullptr);
  }
  return all;
}

namespace {

/// Of those that make up a vector all, else the first that is no qualifier.
std::vector<int> SizesOf(const FaultModel& fault) {
  std::vector<int> sizes;
  for (int p = 0; p < std::ssize(fault.parameters()); ++p) {
    const FaultParameter& parameter = fault.parameters()[At(p)];
    if (parameter.qualifies || (!sizes.empty() && !parameter.component)) continue;
    sizes.push_back(p);
  }
  return sizes;
}

}  // namespace

std::vector<SmallestSize> FindSmallestSizes(const HypothesisSet& hypotheses,
                                            const LinearComparison& comparison,
                                            const Eigen::MatrixXd& H, double clear_evidence,
                                            double least_tolerances) {
  constexpr int kHalvings = 20;
  constexpr double kLargest = 4.0;  // deviations of the fault's prior
  std::vector<SmallestSize> smallest;
  for (int k = 0; k < hypotheses.size(); ++k) {
    if (!hypotheses.CanBeFault(k)) continue;
    SmallestSize worst{.fault = k};
    for (const int p : SizesOf(hypotheses.model(k))) {
      const FaultParameter& parameter = hypotheses.model(k).parameters()[At(p)];
      const Eigen::VectorXd column = H.col(hypotheses.first(k) + p);
      const auto named = [&](double z) {
        return comparison.LnBayesFactor(k, z * column, nullptr) >= clear_evidence;
      };
      double least = least_tolerances * hypotheses.ToleranceOf(k, p);
      double most = std::min({kLargest * parameter.fault + std::abs(parameter.fault_at),
                              parameter.most, parameter.plausible});
      if (most < least || !named(most)) {
        most = std::numeric_limits<double>::infinity();
      } else if (named(least)) {
        most = least;
      }
      for (int halving = 0; halving < kHalvings && std::isfinite(most); ++halving) {
        const double middle = 0.5 * (least + most);
        (named(middle) ? most : least) = middle;
      }
      if (most > worst.z) worst = {.fault = k, .parameter = p, .z = most};
    }
    smallest.push_back(worst);
  }
  return smallest;
}

}  // namespace palpate::diagnosis
