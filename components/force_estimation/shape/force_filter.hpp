// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <array>

namespace palpate::force_estimation {

/// Averages a contact's force over frames as far as the noise of a single one asks for. A force is
/// held or changes: two Kalman filters of random walks, a slow and a fast one, weighed by how well
/// each has foretold the frames (interacting multiple models; Blom and Bar-Shalom, The interacting
/// multiple model algorithm for systems with Markovian switching coefficients, IEEE Trans. Autom.
/// Control 33, 1988). A change beyond the noise and the fast walk begins anew.
class ForceFilter {
 public:
  /// `rate_N_s`: how fast forces change, one sigma in a second; 0: nothing is averaged.
  explicit ForceFilter(double rate_N_s = 0.0) : rate_N_s_(rate_N_s) {}

  /// `covariance_N2` of the frame's random error, positive definite; `t_s` not before the last
  /// one's.
  void Update(double t_s, const Eigen::Vector3d& force_N, const Eigen::Matrix3d& covariance_N2);

  const Eigen::Vector3d& force_N() const { return together_.force_N; }
  const Eigen::Matrix3d& covariance_N2() const { return together_.covariance_N2; }  ///< random part

 private:
  struct Walk {
    Eigen::Vector3d force_N = Eigen::Vector3d::Zero();
    Eigen::Matrix3d covariance_N2 = Eigen::Matrix3d::Zero();
    double chance = 0.0;
  };
  using Walks = std::array<Walk, 2>;  ///< held, changing

  static Walk Together(const Walks& walks);
  Walks Mixed() const;
  void BeginAt(const Eigen::Vector3d& force_N, const Eigen::Matrix3d& covariance_N2);

  double rate_N_s_;
  bool started_ = false;
  double t_s_ = 0.0;
  Walks walks_;
  Walk together_;
};

}  // namespace palpate::force_estimation
