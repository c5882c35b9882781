// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <array>

namespace palpate::force_estimation {

struct ForceFilterTuning {
  /// Squared Mahalanobis distance of a change beyond noise and fast walk, which restarts the
  /// filter: 1e-3 of chi-squared with three degrees of freedom. Smaller: noise restarts it more
  /// often; larger: a jump is followed later.
  double changed_chi_squared = 16.27;
  /// Rate of a constant force's creep over that of a changing one. Smaller: less noise in constant
  /// forces, a slower start of changes.
  double constant_share = 0.15;
  /// Probability per frame that a constant force begins to change, or a changing one stops. Larger:
  /// both walks stay probable, with more noise and faster response.
  double switch_probability = 0.05;
  /// Of each walk. Larger: a walk that was improbable for long recovers sooner.
  double least_probability = 1e-12;
};

/// Averages a contact's force over frames by the noise of a single one. A force is constant or
/// changes: two Kalman filters of random walks, a slow and a fast one, weighted by their likelihood
/// (interacting multiple models; Blom and Bar-Shalom, The interacting multiple model algorithm for
/// systems with Markovian switching coefficients, IEEE Trans. Autom. Control 33, 1988). A change
/// beyond the noise and the fast walk restarts the filter.
class ForceFilter {
 public:
  /// `rate_N_s`: change of a force in one second, one sigma; 0: nothing is averaged.
  explicit ForceFilter(double rate_N_s = 0.0, const ForceFilterTuning& tuning = {})
      : rate_N_s_(rate_N_s), tuning_(tuning) {}

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
  using Walks = std::array<Walk, 2>;  ///< constant, changing

  static Walk Together(const Walks& walks);
  Walks Mixed() const;
  void BeginAt(const Eigen::Vector3d& force_N, const Eigen::Matrix3d& covariance_N2);

  double rate_N_s_;
  ForceFilterTuning tuning_;
  bool started_ = false;
  double t_s_ = 0.0;
  Walks walks_;
  Walk together_;
};

}  // namespace palpate::force_estimation
