// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/libs/robot/beam_model.hpp"

namespace palpate::robot {
namespace {

class FrictionKey : public BeamModelTest {
 protected:
  static std::string TextWith(const std::string& coefficient) {
    return Changed("max_tension_N: 20,",
                   "max_tension_N: 20, friction_coefficient: " + coefficient + ",");
  }
};

TEST_F(FrictionKey, IsThatOfTheCable) {
  const auto model = Build(TextWith("0.25"));
  EXPECT_EQ(model->cable(0).friction().coefficient, 0.25);
  EXPECT_EQ(model->cable(0).friction().Sliding(0), 1.0);
  EXPECT_EQ(model->cable(1).friction().coefficient, 0.0);
}

TEST_F(FrictionKey, IsZeroWhereItIsLeftOut) {
  EXPECT_EQ(Build(FullRobotText())->cable(0).friction().coefficient, 0.0);
}

TEST_F(FrictionKey, IsRefusedBelowZero) {
  EXPECT_NE(RefusalOf(TextWith("-0.1")).find("friction_coefficient"), std::string::npos);
  EXPECT_NE(RefusalOf(TextWith(".nan")).find("friction_coefficient"), std::string::npos);
}

TEST_F(FrictionKey, IsWrittenAndReadBack) {
  const RobotDescription robot = ReadText(TextWith("0.25"), folder_ / "robot.yaml");
  const std::string text = FormatRobotFile(robot, "");
  EXPECT_EQ(ReadText(text).cables[0].friction_coefficient, 0.25);
  EXPECT_EQ(ReadText(text).cables[1].friction_coefficient, 0.0);
}

/// Friction in its eyelets changes what the cable does; the balance is still found to the
/// tolerance of robots without friction.
TEST_F(FrictionKey, EquilibriaAreReached) {
  for (const std::string coefficient : {"0.2", "0.6"}) {
    const auto rubbing = Build(TextWith(coefficient));
    const auto smooth = Build(FullRobotText());
    const std::vector<std::vector<ActuatorCommand>> commands{
        {Displace(0.004), Displace(0.002)}, {Displace(0.010), {}}, {Pull(0.8), Displace(0.003)}};
    for (const std::vector<ActuatorCommand>& cables : commands) {
      fem::StaticState state = rubbing->RestState();
      fem::StaticState without = smooth->RestState();
      const fem::StaticResult result = rubbing->Solve(cables, {}, &state);
      ASSERT_TRUE(result.status.ok()) << result.status.message();
      ASSERT_TRUE(smooth->Solve(cables, {}, &without).status.ok());
      EXPECT_LE(result.residual_relative, 1e-10);
      EXPECT_LE(result.constraint_error_m, 1e-10);
      EXPECT_GT((state.x_m - without.x_m).cwiseAbs().maxCoeff(), 1e-6);
    }
  }
}

}  // namespace
}  // namespace palpate::robot
