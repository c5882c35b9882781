// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>

#include "components/virtual_robot/bench_body.hpp"
#include "components/virtual_robot/effects.hpp"

namespace palpate::virtual_robot {

/// Where the clamped nodes are. With base_compliance the clamp turns about the middle of these
/// nodes by compliance times the torque with which the body loads it, and gets there with a time
/// constant of kSettling_s (a clamp has some damping; it also keeps the steps stable).
class CompliantBase {
 public:
  static constexpr double kSettling_s = 0.02;

  CompliantBase(const BenchBody& body, const Effects& effects);

  bool active() const { return compliance_rad_Nm_ > 0.0; }
  const Eigen::Vector3d& rotation_rad() const { return rotation_rad_; }
  void Reset() { rotation_rad_.setZero(); }
  /// Puts the clamped nodes of `x_m` [3n] where they are.
  void Apply(Eigen::VectorXd* x_m) const;
  /// Where the rotation tends to; `residual_N` [3n]: what the balance leaves over, which in clamped
  /// nodes is the force of the body on the clamp.
  Eigen::Vector3d Wanted_rad(const Eigen::VectorXd& x_m, const Eigen::VectorXd& residual_N) const;
  /// A share of the way there.
  void Approach(const Eigen::Vector3d& wanted_rad, double share) {
    rotation_rad_ += share * (wanted_rad - rotation_rad_);
  }
  /// What the clamp does in `h_s`.
  static double Share(double h_s) { return h_s / (h_s + kSettling_s); }

 private:
  double compliance_rad_Nm_ = 0.0;
  Eigen::Vector3d rotation_rad_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d centre_m_ = Eigen::Vector3d::Zero();
  std::vector<int> held_;  ///< nodes
  Eigen::VectorXd rest_m_;
};

}  // namespace palpate::virtual_robot
