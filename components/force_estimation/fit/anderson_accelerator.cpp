// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/fit/anderson_accelerator.hpp"

#include <algorithm>

#include "libs/core/index.hpp"
#include "libs/linalg/symmetric_eigen.hpp"

namespace palpate::force_estimation {

namespace {

struct AccelerationTuning {
  /// Eigenvalues of the scaled Gram matrix below this share, per pair, count as linear dependence.
  /// Larger drops information, smaller amplifies rounding and noise.
  double least_eigenvalue = 1e-4;
  /// Longest correction, in steps. Larger accelerates more, but extrapolates across changes of
  /// curvature.
  double longest_correction = 2.0;
};
constexpr AccelerationTuning kAccelerationTuning;

void Resize(FitVariables* variables, Eigen::Index nodes3, Eigen::Index cables,
            Eigen::Index forces) {
  variables->x_m.resize(nodes3);
  variables->lambda_a_N.resize(cables);
  variables->lambda_f_N.resize(forces);
}

void Subtract(const FitVariables& a, const FitVariables& b, FitVariables* difference) {
  difference->x_m = a.x_m - b.x_m;
  difference->lambda_a_N = a.lambda_a_N - b.lambda_a_N;
  difference->lambda_f_N = a.lambda_f_N - b.lambda_f_N;
}

void Add(double share, const FitVariables& term, FitVariables* sum) {
  sum->x_m += share * term.x_m;
  sum->lambda_a_N += share * term.lambda_a_N;
  sum->lambda_f_N += share * term.lambda_f_N;
}

}  // namespace

void AndersonAccelerator::SetUp(Eigen::Index nodes3, Eigen::Index cables, Eigen::Index forces) {
  Forget();
  for (Pair& pair : pairs_) {
    Resize(&pair.moved, nodes3, cables, forces);
    Resize(&pair.changed, nodes3, cables, forces);
  }
  Resize(&last_at_, nodes3, cables, forces);
  Resize(&last_step_, nodes3, cables, forces);
}

bool AndersonAccelerator::Correct(const FitVariables& at, const FitVariables& step,
                                  FitVariables* correction) {
  if (has_last_) AddPair(at, step);
  last_at_ = at;
  last_step_ = step;
  has_last_ = true;
  if (count_ == 0) return false;
  // Least squares of the step in the span of the pairs, in their independent directions.
  using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kDepth, 1>;
  Vector along(count_);
  for (int k = 0; k < count_; ++k) {
    along[k] = pairs_[At(k)].changed.x_m.dot(step.x_m);
  }
  const Vector size = gram_.diagonal().head(count_).cwiseSqrt();
  const linalg::SmallMatrix scaled = size.cwiseInverse().asDiagonal() *
                                     gram_.topLeftCorner(count_, count_) *
                                     size.cwiseInverse().asDiagonal();
  const linalg::SmallSymmetricEigen eigen = linalg::DecomposeSymmetric(scaled);
  const Vector seen = eigen.vectors.transpose() * along.cwiseQuotient(size);
  Vector share = Vector::Zero(count_);
  for (int k = 0; k < count_; ++k) {
    const double value = eigen.values[k];
    if (value <= kAccelerationTuning.least_eigenvalue * count_) continue;
    share += eigen.vectors.col(k) * (seen[k] / value);
  }
  share = share.cwiseQuotient(size);
  double longest_m2 = 0.0;
  for (int k = 0; k < count_; ++k) {
    const Pair& pair = pairs_[At(k)];
    longest_m2 = std::max(longest_m2, share[k] * share[k] * pair.moved.x_m.squaredNorm());
  }
  if (!(longest_m2 <= kAccelerationTuning.longest_correction *
                          kAccelerationTuning.longest_correction *
                          std::max(step.x_m.squaredNorm(), last_step_.x_m.squaredNorm()))) {
    return false;
  }
  correction->x_m.setZero(step.x_m.size());
  correction->lambda_a_N.setZero(step.lambda_a_N.size());
  correction->lambda_f_N.setZero(step.lambda_f_N.size());
  for (int k = 0; k < count_; ++k) {
    const Pair& pair = pairs_[At(k)];
    Add(-share[k], pair.moved, correction);
    Add(-share[k], pair.changed, correction);
  }
  return true;
}

/// Replaces the oldest pair.
void AndersonAccelerator::AddPair(const FitVariables& at, const FitVariables& step) {
  if (!((step.x_m - last_step_.x_m).squaredNorm() > 0.0)) return;
  Pair& pair = pairs_[At(next_)];
  Subtract(at, last_at_, &pair.moved);
  Subtract(step, last_step_, &pair.changed);
  count_ = std::max(count_, next_ + 1);
  for (int k = 0; k < count_; ++k) {
    gram_(next_, k) = gram_(k, next_) = pair.changed.x_m.dot(pairs_[At(k)].changed.x_m);
  }
  next_ = (next_ + 1) % kDepth;
}

}  // namespace palpate::force_estimation
