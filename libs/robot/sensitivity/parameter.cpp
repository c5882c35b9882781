// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/robot/sensitivity/parameter.hpp"

namespace palpate::robot {

void ParameterColumn::Reset(Eigen::Index nodal_size, Eigen::Index cables) {
  nodal_size_ = nodal_size;
  length_m.setZero(cables);
  commanded_length_m.setZero(cables);
  commanded_tension_N.setZero(cables);
  point_forces_.clear();
  is_distributed_ = false;
  has_held_motion_ = false;
}

Eigen::VectorXd& ParameterColumn::distributed_force_N() {
  if (!is_distributed_) distributed_force_.setZero(nodal_size_);
  is_distributed_ = true;
  return distributed_force_;
}

void ParameterColumn::AddForce(const fem::InterpolationWeights& point,
                               const Eigen::Vector3d& force_N) {
  for (size_t k = 0; k < point.nodes.size(); ++k) {
    point_forces_.emplace_back(point.nodes[k], point.weights[k] * force_N);
  }
}

Eigen::VectorXd& ParameterColumn::held_motion_m() {
  if (!has_held_motion_) held_motion_.setZero(nodal_size_);
  has_held_motion_ = true;
  return held_motion_;
}

void ParameterColumn::Add(double factor, const ParameterColumn& other) {
  if (other.is_distributed_) distributed_force_N() += factor * other.distributed_force_;
  for (const auto& [node, force_N] : other.point_forces_) {
    point_forces_.emplace_back(node, factor * force_N);
  }
  if (other.has_held_motion_) held_motion_m() += factor * other.held_motion_;
  length_m += factor * other.length_m;
  commanded_length_m += factor * other.commanded_length_m;
  commanded_tension_N += factor * other.commanded_tension_N;
}

void ParameterColumn::AddForceTo(Eigen::Ref<Eigen::VectorXd> nodal_N) const {
  if (is_distributed_) nodal_N += distributed_force_;
  for (const auto& [node, force_N] : point_forces_) nodal_N.segment<3>(3 * node) += force_N;
}

}  // namespace palpate::robot
