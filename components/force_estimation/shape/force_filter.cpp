// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/shape/force_filter.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace palpate::force_estimation {

/// The mean of the walks by their chances, with their own spread and that between them.
ForceFilter::Walk ForceFilter::Together(const Walks& walks) {
  Walk all;
  for (const Walk& walk : walks) all.chance += walk.chance;
  for (const Walk& walk : walks) all.force_N += walk.chance / all.chance * walk.force_N;
  for (const Walk& walk : walks) {
    const Eigen::Vector3d off_N = walk.force_N - all.force_N;
    all.covariance_N2 +=
        walk.chance / all.chance * (walk.covariance_N2 + off_N * off_N.transpose());
  }
  return all;
}

/// The start of each walk: forces may have begun or stopped to change since the last frame.
ForceFilter::Walks ForceFilter::Mixed() const {
  Walks mixed;
  for (std::size_t to = 0; to < mixed.size(); ++to) {
    Walks from = walks_;
    for (std::size_t k = 0; k < from.size(); ++k) {
      from[k].chance *= k == to ? 1.0 - tuning_.switch_probability : tuning_.switch_probability;
    }
    mixed[to] = Together(from);
  }
  return mixed;
}

void ForceFilter::BeginAt(const Eigen::Vector3d& force_N, const Eigen::Matrix3d& covariance_N2) {
  walks_.fill({.force_N = force_N, .covariance_N2 = covariance_N2, .chance = 0.5});
  together_ = {.force_N = force_N, .covariance_N2 = covariance_N2, .chance = 1.0};
}

void ForceFilter::Update(double t_s, const Eigen::Vector3d& force_N,
                         const Eigen::Matrix3d& covariance_N2) {
  const double passed_s = std::max(0.0, t_s - t_s_);
  t_s_ = t_s;
  if (!started_ || rate_N_s_ <= 0.0) {
    started_ = true;
    BeginAt(force_N, covariance_N2);
    return;
  }
  Walks walks = Mixed();
  double sum = 0.0;
  for (std::size_t k = 0; k < walks.size(); ++k) {
    Walk& walk = walks[k];
    const double walk_N = (k == 0 ? tuning_.constant_share : 1.0) * rate_N_s_ * passed_s;
    const Eigen::Matrix3d predicted =
        walk.covariance_N2 + walk_N * walk_N * Eigen::Matrix3d::Identity();
    const Eigen::LLT<Eigen::Matrix3d> spread(predicted + covariance_N2);
    const Eigen::Vector3d change_N = force_N - walk.force_N;
    const double distance = change_N.dot(spread.solve(change_N));
    const bool fast = k == 1;
    if (spread.info() != Eigen::Success || !(distance <= tuning_.changed_chi_squared || !fast)) {
      BeginAt(force_N, covariance_N2);
      return;
    }
    const Eigen::Matrix3d gain = spread.solve(predicted).transpose();
    walk.force_N += gain * change_N;
    const Eigen::Matrix3d left = predicted - gain * predicted;
    walk.covariance_N2 = 0.5 * (left + left.transpose());
    walk.chance *= std::exp(-0.5 * distance) / spread.matrixLLT().diagonal().prod();
    sum += walk.chance;
  }
  for (Walk& walk : walks)
    walk.chance = std::max(tuning_.least_probability, sum > 0.0 ? walk.chance / sum : 1.0);
  walks_ = walks;
  together_ = Together(walks_);
}

}  // namespace palpate::force_estimation
