// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/correspondence/robust_mean.hpp"

#include <algorithm>

#include "libs/core/statistics.hpp"

namespace palpate::correspondence {

namespace {

constexpr double kBiweight = 4.685;     // 95 % efficiency on Gaussian errors
constexpr double kSigmaOfMad = 1.4826;  // of Gaussian errors
constexpr int kRounds = 3;

}  // namespace

/// Of the values that have any weight.
double RobustMean::MedianOf(const Eigen::Ref<const Eigen::VectorXd>& value,
                            const Eigen::Ref<const Eigen::VectorXd>& weight) {
  sorted_.clear();
  for (Eigen::Index k = 0; k < value.size(); ++k) {
    if (weight[k] > 0.0) sorted_.push_back(value[k]);
  }
  return sorted_.empty() ? 0.0 : UpperMedian(sorted_);
}

void RobustMean::LowerWeights(const Eigen::Ref<const Eigen::VectorXd>& value,
                              const Eigen::Ref<const Eigen::VectorXd>& sigma,
                              Eigen::Ref<Eigen::VectorXd> weight) {
  double mean = MedianOf(value, weight);
  lowered_ = (value.array() - mean).abs();
  const double scatter = kSigmaOfMad * MedianOf(lowered_, weight);
  for (int round = 0; round < kRounds; ++round) {
    for (Eigen::Index k = 0; k < value.size(); ++k) {
      const double share = (value[k] - mean) / (kBiweight * std::max(sigma[k], scatter));
      const double kept = std::max(0.0, 1.0 - share * share);
      lowered_[k] = weight[k] * kept * kept;
    }
    const double sum = lowered_.sum();
    if (sum > 0.0) mean = lowered_.dot(value) / sum;
  }
  weight = lowered_;
}

}  // namespace palpate::correspondence
