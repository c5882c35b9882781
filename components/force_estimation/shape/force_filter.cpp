// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/shape/force_filter.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

namespace palpate::force_estimation {

namespace {

/// Squared distance, in its covariance, at which a change counts as real: 1e-3 of chi-squared with
/// three degrees of freedom.
constexpr double kRealChange = 16.27;

}  // namespace

void ForceFilter::Update(double t_s, const Eigen::Vector3d& force_N,
                         const Eigen::Matrix3d& covariance_N2) {
  const double walk_N = rate_N_s_ * std::max(0.0, t_s - t_s_);
  t_s_ = t_s;
  const Eigen::Matrix3d predicted = covariance_N2_ + walk_N * walk_N * Eigen::Matrix3d::Identity();
  const Eigen::Vector3d change_N = force_N - force_N_;
  const Eigen::LDLT<Eigen::Matrix3d> sum(predicted + covariance_N2);
  const bool follows = started_ && rate_N_s_ > 0.0 && sum.info() == Eigen::Success &&
                       change_N.dot(sum.solve(change_N)) <= kRealChange;
  started_ = true;
  if (!follows) {
    force_N_ = force_N;
    covariance_N2_ = covariance_N2;
    return;
  }
  const Eigen::Matrix3d gain = sum.solve(predicted).transpose();
  force_N_ += gain * change_N;
  const Eigen::Matrix3d left = predicted - gain * predicted;
  covariance_N2_ = 0.5 * (left + left.transpose());
}

}  // namespace palpate::force_estimation
