// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>

#include "components/force_estimation/fit/force_newton.hpp"

namespace palpate::force_estimation {

/// The mean of the markers over frames in which contacts, forces and cables stay as they are.
class TargetPool {
 public:
  /// A frame with its fit. References hold during the call only.
  struct Frame {
    const RowTargets& targets;
    const Eigen::VectorXd& shared_variance_m2;  ///< [rows] of an error that all frames share
    const Eigen::VectorXd& free_m;              ///< [rows] of the model without contact
    const Eigen::VectorXd& forces_N;            ///< [3k]
    const Eigen::MatrixXd& covariance_N2;       ///< [3k x 3k] of the forces
    double noise_scale = 1.0;                   ///< of covariances and variances, >= 1
  };

  /// Forgets all frames.
  void Clear() { frames_ = 0; }
  /// Adds the frame; one that is not like those before begins the mean again. True where the number
  /// of frames is 4, 8, 16, ...
  bool Add(const Frame& frame);
  /// Of the frames added; rows that were measured in none have weight 0.
  RowTargets Mean() const;

 private:
  bool IsLikeBefore(const Frame& frame) const;
  void Begin(const Frame& frame);

  int frames_ = 0;
  Eigen::VectorXd free_m_;       ///< [rows] of the first frame
  Eigen::VectorXd force_sum_N_;  ///< [3k]
  Eigen::VectorXd sum_m_;        ///< [rows]
  Eigen::VectorXd variance_m2_;  ///< [rows] sum of the variances that frames do not share
  Eigen::VectorXd shared_m2_;    ///< [rows] of the last frame
  Eigen::VectorXd count_;        ///< [rows] frames that measured it
};

}  // namespace palpate::force_estimation
