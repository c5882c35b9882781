// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <functional>

#include "libs/core/check.hpp"
#include "libs/robot/sensitivity/equilibrium_point.hpp"
#include "libs/robot/sensitivity/parameters.hpp"

namespace palpate::robot {

namespace {

using Kind = ActuatorCommand::Kind;
/// Change of a command's value per unit of the parameter.
using Change = std::function<double(const EquilibriumPoint&)>;

/// Change of what an actuator does where it is commanded in one way; without effect in the other.
class CommandChange final : public Parameter {
 public:
  CommandChange(Kind kind, int cable, Change change)
      : kind_(kind), cable_(cable), change_(std::move(change)) {}

  void Describe(const EquilibriumPoint& at, ParameterColumn* column) const override {
    if (at.command(cable_).kind != kind_) return;
    if (kind_ == Kind::kTension) {
      column->commanded_tension_N[cable_] = change_(at);
    } else {
      column->commanded_length_m[cable_] = -change_(at);
    }
  }

 private:
  Kind kind_;
  int cable_;
  Change change_;
};

ParameterPtr Offset(Kind kind, int cable) {
  return std::make_unique<CommandChange>(kind, cable, [](const EquilibriumPoint&) { return 1.0; });
}

/// The command holds the gain and the offset already.
ParameterPtr Gain(Kind kind, int cable, double gain, double offset) {
  PALPATE_CHECK(gain > -1.0, gain);
  return std::make_unique<CommandChange>(kind, cable, [=](const EquilibriumPoint& at) {
    return (at.command(cable).value - offset) / (1.0 + gain);
  });
}

}  // namespace

ParameterPtr CableOffset(int cable) { return Offset(Kind::kDisplacement, cable); }

ParameterPtr CableGain(int cable, double gain, double offset_m) {
  return Gain(Kind::kDisplacement, cable, gain, offset_m);
}

ParameterPtr TensionOffset(int cable) { return Offset(Kind::kTension, cable); }

ParameterPtr TensionGain(int cable, double gain, double offset_N) {
  return Gain(Kind::kTension, cable, gain, offset_N);
}

ParameterPtr DriveCoupling(int driven, int by) {
  return std::make_unique<CommandChange>(
      Kind::kDisplacement, driven, [by](const EquilibriumPoint& at) {
        return at.command(by).kind == Kind::kDisplacement ? at.command(by).value : 0.0;
      });
}

ParameterPtr CableCompliance(int cable) {
  return std::make_unique<CommandChange>(
      Kind::kDisplacement, cable,
      [cable](const EquilibriumPoint& at) { return -at.tension_N(cable); });
}

}  // namespace palpate::robot
