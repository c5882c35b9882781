// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/target_pool.hpp"

#include <algorithm>
#include <cmath>

namespace palpate::force_estimation {

namespace {

struct TargetPoolTuning {
  /// Change of a force component, in standard deviations, from which the contact is another state.
  double force_sigmas = 5.0;
  /// Frames of the first mean that is searched. More: the first location holds longer.
  int first_frames = 4;
};
constexpr TargetPoolTuning kTargetPoolTuning;

bool IsPowerOfTwo(int number) { return (number & (number - 1)) == 0; }

}  // namespace

bool TargetPool::Add(const Frame& frame) {
  if (frames_ == 0 || !IsLikeBefore(frame)) Begin(frame);
  ++frames_;
  force_sum_N_ += frame.forces_N;
  shared_m2_ = frame.shared_variance_m2;
  for (Eigen::Index row = 0; row < sum_m_.size(); ++row) {
    const double weight = frame.targets.weight[row];
    if (!(weight > 0.0)) continue;
    sum_m_[row] += frame.targets.value_m[row];
    variance_m2_[row] += std::max(0.0, 1.0 / weight - frame.shared_variance_m2[row]);
    count_[row] += 1.0;
  }
  return frames_ >= kTargetPoolTuning.first_frames && IsPowerOfTwo(frames_);
}

RowTargets TargetPool::Mean() const {
  RowTargets mean{.value_m = Eigen::VectorXd::Zero(sum_m_.size()),
                  .weight = Eigen::VectorXd::Zero(sum_m_.size())};
  for (Eigen::Index row = 0; row < sum_m_.size(); ++row) {
    if (!(count_[row] > 0.0)) continue;
    mean.value_m[row] = sum_m_[row] / count_[row];
    mean.weight[row] = 1.0 / (variance_m2_[row] / (count_[row] * count_[row]) + shared_m2_[row]);
    ++mean.rows;
  }
  return mean;
}

bool TargetPool::IsLikeBefore(const Frame& frame) const {
  if (frame.free_m.size() != free_m_.size() || frame.forces_N.size() != force_sum_N_.size()) {
    return false;
  }
  const Eigen::ArrayXd moved = (frame.free_m - free_m_).array();
  const double moved_sigmas2 = (moved.square() * frame.targets.weight.array()).sum();
  if (moved_sigmas2 > frame.targets.rows * frame.noise_scale) return false;
  const Eigen::ArrayXd change_N = (frame.forces_N - force_sum_N_ / frames_).array();
  const Eigen::ArrayXd variance_N2 = frame.noise_scale * frame.covariance_N2.diagonal().array();
  const double limit = kTargetPoolTuning.force_sigmas * kTargetPoolTuning.force_sigmas;
  return (change_N.square() <= limit * variance_N2).all();
}

void TargetPool::Begin(const Frame& frame) {
  const Eigen::Index rows = frame.targets.value_m.size();
  frames_ = 0;
  free_m_ = frame.free_m;
  force_sum_N_ = Eigen::VectorXd::Zero(frame.forces_N.size());
  sum_m_ = variance_m2_ = count_ = Eigen::VectorXd::Zero(rows);
}

}  // namespace palpate::force_estimation
