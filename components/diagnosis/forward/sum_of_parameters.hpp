// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "libs/fem/interpolation_weights.hpp"
#include "libs/robot/sensitivity/parameter.hpp"

namespace palpate::diagnosis {

/// One parameter that changes several at once, each by its factor.
class SumOfParameters final : public robot::Parameter {
 public:
  void Add(double factor, robot::ParameterPtr part) {
    parts_.emplace_back(factor, std::move(part));
  }
  bool empty() const { return parts_.empty(); }

  void Describe(const robot::EquilibriumPoint& at, robot::ParameterColumn* column) const override;

 private:
  std::vector<std::pair<double, robot::ParameterPtr>> parts_;
};

/// factor times the parameter.
robot::ParameterPtr Scaled(double factor, robot::ParameterPtr parameter);

/// What the actuators take in changes by so much (m, or N where a tension is commanded).
robot::ParameterPtr CommandChange(Eigen::VectorXd change);

/// Dead loads on points of the body.
robot::ParameterPtr PointForce(fem::InterpolationWeights weights, const Eigen::Vector3d& force_N);

}  // namespace palpate::diagnosis
