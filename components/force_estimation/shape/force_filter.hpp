// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>

namespace palpate::force_estimation {

/// Averages a contact's force over frames as far as the noise of a single one asks for (a Kalman
/// filter of a random walk): a force that one frame tells well follows at once, one that is buried
/// in noise is averaged. A change beyond the noise and the walk begins anew.
class ForceFilter {
 public:
  /// `rate_N_s`: how fast forces change, one sigma in a second; 0: nothing is averaged.
  explicit ForceFilter(double rate_N_s = 0.0) : rate_N_s_(rate_N_s) {}

  /// `covariance_N2` of the frame's random error; `t_s` not before the last one's.
  void Update(double t_s, const Eigen::Vector3d& force_N, const Eigen::Matrix3d& covariance_N2);

  const Eigen::Vector3d& force_N() const { return force_N_; }
  const Eigen::Matrix3d& covariance_N2() const { return covariance_N2_; }  ///< random part

 private:
  double rate_N_s_;
  bool started_ = false;
  double t_s_ = 0.0;
  Eigen::Vector3d force_N_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance_N2_ = Eigen::Matrix3d::Zero();
};

}  // namespace palpate::force_estimation
