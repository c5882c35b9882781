// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/robot/sensitivity/equilibrium_point.hpp"
#include "libs/robot/sensitivity/parameters.hpp"

namespace palpate::robot {

namespace {

class FrictionCoefficient final : public Parameter {
 public:
  explicit FrictionCoefficient(int cable) : cable_(cable) {}

  void Describe(const EquilibriumPoint& at, ParameterColumn* column) const override {
    const bool pulled_in =
        at.model().cable(cable_).friction().sliding == CableFriction::Sliding::kIn;
    Eigen::Matrix3Xd force;
    at.path(cable_).ForceAlongFriction(&force);
    at.PullPath(cable_, pulled_in ? at.tension_N(cable_) : -at.tension_N(cable_), force, column);
  }

 private:
  int cable_;
};

}  // namespace

ParameterPtr CableFrictionCoefficient(int cable) {
  return std::make_unique<FrictionCoefficient>(cable);
}

}  // namespace palpate::robot
