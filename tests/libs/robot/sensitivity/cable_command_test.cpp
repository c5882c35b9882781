// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/libs/robot/sensitivity/robot_case.hpp"

namespace palpate::robot {
namespace {

class CableCommands : public SensitivityCase {
 protected:
  bool Displaced(size_t cable) const {
    return robot_.cables[cable].kind == ActuatorCommand::Kind::kDisplacement;
  }
  /// Cables under displacement control that are taut.
  std::vector<int> Driven() const {
    std::vector<int> driven;
    for (size_t c = 0; c < robot_.cables.size(); ++c) {
      if (Displaced(c) && robot_.cables[c].value > 0.0) driven.push_back(static_cast<int>(c));
    }
    return driven;
  }
  std::vector<int> Pulled() const {
    std::vector<int> pulled;
    for (size_t c = 0; c < robot_.cables.size(); ++c) {
      if (robot_.cables[c].kind == ActuatorCommand::Kind::kTension) {
        pulled.push_back(static_cast<int>(c));
      }
    }
    return pulled;
  }
  /// The command of a cable grows by `factor` times the parameter.
  Change Taking(int cable, double factor) const {
    return [=, this](double by) {
      RobotCase robot = robot_;
      robot.cables[static_cast<size_t>(cable)].value += by * factor;
      return robot;
    };
  }
};

TEST_P(CableCommands, Offset) {
  for (const int c : Driven()) ExpectDerivative(robot_, CableOffset(c), Taking(c, 1.0), 1e-5);
}

TEST_P(CableCommands, Gain) {
  for (const int c : Driven()) {
    const double command_m = robot_.cables[static_cast<size_t>(c)].value;
    ExpectDerivative(robot_, CableGain(c), Taking(c, command_m), 1e-3);
    // The command holds a gain of 0.1 and an offset of 1 mm already.
    ExpectDerivative(robot_, CableGain(c, 0.1, 1e-3), Taking(c, (command_m - 1e-3) / 1.1), 1e-3);
  }
}

TEST_P(CableCommands, TensionOffsetWithAndWithoutFriction) {
  for (const double mu : {0.0, 0.3}) {
    for (CableFriction& friction : robot_.friction) friction.coefficient = mu;
    for (const int c : Pulled()) {
      ExpectDerivative(robot_, TensionOffset(c), Taking(c, 1.0), 1e-3);
    }
  }
}

TEST_P(CableCommands, TensionGain) {
  for (const int c : Pulled()) {
    const double command_N = robot_.cables[static_cast<size_t>(c)].value;
    ExpectDerivative(robot_, TensionGain(c), Taking(c, command_N), 1e-3);
    // The command holds a gain of 0.1 and an offset of 0.02 N already.
    ExpectDerivative(robot_, TensionGain(c, 0.1, 0.02), Taking(c, (command_N - 0.02) / 1.1), 1e-3);
  }
}

TEST_P(CableCommands, CouplingOfDrives) {
  for (const int c : Driven()) {
    for (const int by : Driven()) {
      ExpectDerivative(robot_, DriveCoupling(c, by),
                       Taking(c, robot_.cables[static_cast<size_t>(by)].value), 1e-3);
    }
  }
}

TEST_P(CableCommands, ComplianceOfACable) {
  for (const int c : Driven()) {
    const auto changed = [&](double compliance_m_N) {
      RobotCase robot = robot_;
      robot.compliance_m_N[c] += compliance_m_N;
      return robot;
    };
    ExpectDerivative(robot_, CableCompliance(c), changed, 2e-5);
    robot_.compliance_m_N[c] = c == 0 ? 2e-3 : -2e-4;
    ExpectDerivative(robot_, CableCompliance(c), changed, 2e-5);
  }
}

/// A compliance below zero reduces that of the mesh.
TEST_P(CableCommands, OffsetOfCablesThatStretch) {
  robot_.compliance_m_N << 2e-3, -2e-4, 5e-4;
  for (const double mu : {0.0, 0.3}) {
    for (CableFriction& friction : robot_.friction) friction.coefficient = mu;
    for (const int c : Driven()) ExpectDerivative(robot_, CableOffset(c), Taking(c, 1.0), 1e-5);
  }
}

TEST_P(CableCommands, DoNothingToACableThatIsSlackOrDrivenInTheOtherWay) {
  Balance balance = Solve(robot_);
  for (int c = 0; c < 3; ++c) {
    const bool taut = balance.Tensions_N()[c] > 0.0 && Displaced(static_cast<size_t>(c));
    std::vector<ParameterPtr> parameters;
    if (!taut) parameters.push_back(CableOffset(c));
    if (!taut) parameters.push_back(CableGain(c));
    if (Displaced(static_cast<size_t>(c))) parameters.push_back(TensionOffset(c));
    if (Displaced(static_cast<size_t>(c))) parameters.push_back(TensionGain(c));
    for (ParameterPtr& parameter : parameters) {
      const Derivative derivative = Differentiate(balance, robot_, std::move(parameter));
      EXPECT_EQ(derivative.points_m.norm(), 0.0);
      EXPECT_EQ(derivative.tensions_N.norm(), 0.0);
      EXPECT_EQ(derivative.lengths_m.norm(), 0.0);
    }
  }
}

TEST_P(CableCommands, AnOffsetActsOnItsOwnCableAlone) {
  Balance balance = Solve(robot_);
  for (const int c : Driven()) {
    const Derivative derivative = Differentiate(balance, robot_, CableOffset(c));
    EXPECT_NEAR(derivative.lengths_m[c], -1.0, 1e-9);
  }
  for (const int c : Pulled()) {
    const Derivative derivative = Differentiate(balance, robot_, TensionOffset(c));
    EXPECT_EQ(derivative.tensions_N[c], 1.0);
  }
}

INSTANTIATE_TEST_SUITE_P(SoftBeam, CableCommands, AllCases());

}  // namespace
}  // namespace palpate::robot
