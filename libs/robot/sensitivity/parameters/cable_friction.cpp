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
    Eigen::Matrix3Xd force;
    at.path(cable_).ForceAlongFriction(&force);
    at.PullPath(cable_, at.tension_N(cable_), force, column);
  }

 private:
  int cable_;
};

class FrictionAtEyelet final : public Parameter {
 public:
  FrictionAtEyelet(int cable, int eyelet) : cable_(cable), eyelet_(eyelet) {}

  void Describe(const EquilibriumPoint& at, ParameterColumn* column) const override {
    Eigen::Matrix3Xd force;
    at.path(cable_).ForceAlongFrictionAt(eyelet_, &force);
    at.PullPath(cable_, at.tension_N(cable_), force, column);
  }

 private:
  int cable_, eyelet_;
};

}  // namespace

ParameterPtr CableFrictionCoefficient(int cable) {
  return std::make_unique<FrictionCoefficient>(cable);
}

ParameterPtr CableFrictionAt(int cable, int eyelet) {
  return std::make_unique<FrictionAtEyelet>(cable, eyelet);
}

}  // namespace palpate::robot
