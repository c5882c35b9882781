// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/core/check.hpp"
#include "libs/robot/sensitivity/equilibrium_point.hpp"
#include "libs/robot/sensitivity/parameters.hpp"

namespace palpate::robot {

namespace {

class PointForce final : public Parameter {
 public:
  PointForce(fem::InterpolationWeights weights, const Eigen::Vector3d& direction)
      : weights_(std::move(weights)), direction_(direction) {}

  void Describe(const EquilibriumPoint&, ParameterColumn* column) const override {
    column->AddForce(weights_, direction_);
  }

 private:
  fem::InterpolationWeights weights_;
  Eigen::Vector3d direction_;
};

class NodalForces final : public Parameter {
 public:
  explicit NodalForces(Eigen::VectorXd force_N) : force_N_(std::move(force_N)) {}

  void Describe(const EquilibriumPoint&, ParameterColumn* column) const override {
    PALPATE_CHECK(force_N_.size() == column->distributed_force_N().size(), force_N_.size());
    column->distributed_force_N() += force_N_;
  }

 private:
  Eigen::VectorXd force_N_;
};

}  // namespace

ParameterPtr ExternalForce(fem::InterpolationWeights weights, const Eigen::Vector3d& direction) {
  return std::make_unique<PointForce>(std::move(weights), direction);
}

ParameterPtr NodalForce(Eigen::VectorXd force_N) {
  return std::make_unique<NodalForces>(std::move(force_N));
}

}  // namespace palpate::robot
