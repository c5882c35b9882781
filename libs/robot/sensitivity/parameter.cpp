// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/robot/sensitivity/parameter.hpp"

namespace palpate::robot {

void ParameterColumn::Reset(Eigen::Index nodal_size, Eigen::Index cables) {
  force_.resize(nodal_size);
  held_motion_.resize(nodal_size);
  length_m.setZero(cables);
  commanded_length_m.setZero(cables);
  commanded_tension_N.setZero(cables);
  has_force_ = false;
  has_held_motion_ = false;
}

Eigen::VectorXd& ParameterColumn::force_N() {
  if (!has_force_) force_.setZero();
  has_force_ = true;
  return force_;
}

void ParameterColumn::AddForce(const fem::NodeWeights& point, const Eigen::Vector3d& force_N) {
  Eigen::VectorXd& nodal_N = this->force_N();
  for (size_t k = 0; k < point.nodes.size(); ++k) {
    nodal_N.segment<3>(3 * point.nodes[k]) += point.weights[k] * force_N;
  }
}

Eigen::VectorXd& ParameterColumn::held_motion_m() {
  if (!has_held_motion_) held_motion_.setZero();
  has_held_motion_ = true;
  return held_motion_;
}

}  // namespace palpate::robot
