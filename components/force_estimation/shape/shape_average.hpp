// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "components/force_estimation/shape/shape_targets.hpp"

namespace palpate::force_estimation {

/// What contacts do to the features, averaged over the frames in which they hold still: where a
/// contact is that nobody sees is told by all of these frames together, not by the last one.
class ShapeAverage {
 public:
  explicit ShapeAverage(int feature_count);

  void Forget();
  /// A frame: `motion_m` of the rows of `targets`. One that is off the mean by more than the noise
  /// begins anew.
  void Add(const ShapeTargets& targets, const Eigen::VectorXd& motion_m);

  int frames() const { return frames_; }  ///< since it began
  /// Means of the rows of the frame that was added last, m, and their weights: 1 / variance of
  /// what averaging leaves of the noise and of what is constant.
  const Eigen::VectorXd& motion_m() const { return motion_m_; }
  const Eigen::VectorXd& weight() const { return weight_; }

 private:
  bool Fits(const ShapeTargets& targets, const Eigen::VectorXd& motion_m) const;

  int frames_ = 0;
  Eigen::VectorXd mean_m_;  ///< [features]
  std::vector<int> count_;  ///< [features]
  Eigen::VectorXd motion_m_;
  Eigen::VectorXd weight_;
};

}  // namespace palpate::force_estimation
