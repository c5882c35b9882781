// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <cmath>

#include "components/virtual_robot/actuator_chain.hpp"
#include "libs/robot/robot_model.hpp"
#include "tests/components/virtual_robot/bench_setup.hpp"
#include "tests/support/robots.hpp"

namespace palpate::virtual_robot::test {
namespace {

using test_support::LinearFourLegRobot;

/// Pulls cables in within a second.
std::unique_ptr<VirtualRobot> Pulled(const robot::RobotDescription& description,
                                     const std::vector<double>& command_m,
                                     const Effects& effects = {}) {
  auto robot = std::make_unique<VirtualRobot>(description, PlainScenario(), effects, 1);
  EXPECT_TRUE(robot->Start(0.0, Commands(std::vector<double>(command_m.size(), 0.0))).ok());
  EXPECT_TRUE(robot->Advance(1.0, Commands(command_m)).ok());
  return robot;
}

TEST(Cables, WithoutEffectsAreInTheBalanceThatTheStaticSolverFinds) {
  robot::RobotModel model(robot::BuildRobotBody(LinearFourLegRobot()));
  fem::StaticState state = model.RestState();
  using Kind = robot::ActuatorCommand::Kind;
  const std::vector<robot::ActuatorCommand> commands = {{Kind::kDisplacement, 0.008},
                                                        {Kind::kDisplacement, 0.0},
                                                        {Kind::kDisplacement, 0.004},
                                                        {Kind::kNone, 0.0}};
  ASSERT_TRUE(model.Solve(commands, {}, &state).status.ok());
  const auto robot = Pulled(LinearFourLegRobot(), {0.008, 0.0, 0.004, kNotDriven});
  EXPECT_LE((robot->positions_m() - state.x_m).cwiseAbs().maxCoeff(), 1e-6);
  for (int c = 0; c < 4; ++c) {
    EXPECT_NEAR(robot->cables()[static_cast<size_t>(c)].tension_N, state.multipliers_N[c], 1e-4);
  }
  EXPECT_GT(robot->cables()[0].tension_N, 0.5);
  EXPECT_EQ(robot->cables()[0].displacement_m, 0.008);
}

/// North cable pulled by `command_m` with an effect is as pulled by `same_m` without.
void ExpectAs(const Effects& effects, const std::vector<double>& command_m,
              const std::vector<double>& same_m) {
  const auto robot = Pulled(LinearFourLegRobot(), command_m, effects);
  const auto healthy = Pulled(LinearFourLegRobot(), same_m);
  EXPECT_LE((robot->positions_m() - healthy->positions_m()).cwiseAbs().maxCoeff(), 2e-7);
}

TEST(Cables, GainMultipliesWhatIsTakenIn) {
  ExpectAs({Effect("cable_gain", {"cable:north"}, {{"g", 0.1}})}, {0.008, 0, 0, 0},
           {0.0088, 0, 0, 0});
}

TEST(Cables, OffsetIsAddedToIt) {
  ExpectAs({Effect("cable_offset", {"cable:north"}, {{"offset_m", -0.002}})}, {0.008, 0, 0, 0},
           {0.006, 0, 0, 0});
}

TEST(Cables, SwappedOnesPullEachOthers) {
  ExpectAs({Effect("swapped_cables", {"cable:north", "cable:east"}, {})}, {0.008, 0, 0, 0.003},
           {0.003, 0, 0, 0.008});
}

TEST(Cables, CouplingMovesTheDrivenOneToo) {
  ExpectAs({Effect("drive_coupling", {"cable:west", "cable:north"}, {{"coupling", 0.1}})},
           {0.008, 0.001, 0, 0}, {0.008, 0.0018, 0, 0});
}

TEST(Cables, ElasticOneGivesWayByItsTensionOverItsStiffness) {
  constexpr double kStiffness_N_m = 1000.0;
  const auto robot =
      Pulled(LinearFourLegRobot(), {0.008, 0, 0, 0},
             {Effect("cable_elasticity", {"cable:north"}, {{"k_N_m", kStiffness_N_m}})});
  const double tension_N = robot->cables()[0].tension_N;
  EXPECT_GT(tension_N, 0.3);
  const auto healthy = Pulled(LinearFourLegRobot(), {0.008 - tension_N / kStiffness_N_m, 0, 0, 0});
  EXPECT_LE((robot->positions_m() - healthy->positions_m()).cwiseAbs().maxCoeff(), 2e-7);
}

TEST(Cables, CuttingOneGivesWayAtItsKnot) {
  constexpr double kCompliance_m_N = 1e-3;
  const auto robot =
      Pulled(LinearFourLegRobot(), {0.008, 0, 0, 0},
             {Effect("cable_cutting", {"cable:north"}, {{"compliance_m_N", kCompliance_m_N}})});
  const double tension_N = robot->cables()[0].tension_N;
  const auto healthy = Pulled(LinearFourLegRobot(), {0.008 - tension_N * kCompliance_m_N, 0, 0, 0});
  EXPECT_LE((robot->positions_m() - healthy->positions_m()).cwiseAbs().maxCoeff(), 2e-7);
}

TEST(Cables, RoutedElsewherePullsThatWay) {
  robot::RobotDescription moved = LinearFourLegRobot();
  moved.cables[0].path_m.col(0) += Eigen::Vector3d(0.0, 0.004, 0.002);
  const auto expected = Pulled(moved, {0.008, 0, 0, 0});
  const auto robot =
      Pulled(LinearFourLegRobot(), {0.008, 0, 0, 0},
             {Effect("cable_routing", {"cable:north"}, {{"dy_m", 0.004}, {"dz_m", 0.002}})});
  EXPECT_LE((robot->positions_m() - expected->positions_m()).cwiseAbs().maxCoeff(), 2e-7);
}

std::vector<robot::BodyCable> OneCable(double play_m) {
  robot::BodyCable cable;
  cable.name = "a";
  cable.play_m = play_m;
  return {cable};
}

class PlayOfActuators : public testing::TestWithParam<double> {};

/// However much of it the robot file has, and the effect.
TEST_P(PlayOfActuators, IsThePlayOperator) {
  const double in_file_m = GetParam();
  ActuatorChain actuators(OneCable(in_file_m),
                          {Effect("backlash", {"cable:a"}, {{"play_m", 0.002 - in_file_m}})});
  const auto command = [](double value_m) { return Eigen::VectorXd::Constant(1, value_m); };
  actuators.Reset(0.0, command(0.0));
  const auto at = [&](double t_s, double value_m) {
    actuators.Propose(t_s, command(value_m));
    actuators.Commit();
    return actuators.pulled_in_m()[0];
  };
  EXPECT_DOUBLE_EQ(at(1.0, 0.0008), 0.0);
  EXPECT_DOUBLE_EQ(at(2.0, 0.005), 0.004);
  EXPECT_DOUBLE_EQ(at(3.0, 0.004), 0.004);
  EXPECT_DOUBLE_EQ(at(4.0, 0.003), 0.004);
  EXPECT_DOUBLE_EQ(at(5.0, 0.002), 0.003);
}

INSTANTIATE_TEST_SUITE_P(Shares, PlayOfActuators, testing::Values(0.0, 0.0005, 0.002));

TEST(Actuators, LagIsADelayAndAFirstOrder) {
  constexpr double kDelay_s = 0.1;
  constexpr double kTau_s = 0.3;
  ActuatorChain actuators(OneCable(0.0),
                          {Effect("lag", {"body"}, {{"delay_s", kDelay_s}, {"tau_s", kTau_s}})});
  actuators.Reset(0.0, Eigen::VectorXd::Zero(1));
  for (int k = 1; k <= 100; ++k) {
    const double t_s = 0.02 * k;
    actuators.Propose(t_s, Eigen::VectorXd::Constant(1, 0.01 * t_s));
    actuators.Commit();
    const double since_s = std::max(0.0, t_s - kDelay_s);
    const double expected_m = 0.01 * (since_s - kTau_s * (1.0 - std::exp(-since_s / kTau_s)));
    EXPECT_NEAR(actuators.pulled_in_m()[0], expected_m, 1e-12) << t_s;
  }
}

/// The four legs' north cable over an eyelet on the hub.
robot::RobotDescription Routed() {
  robot::RobotDescription robot = LinearFourLegRobot();
  Eigen::Matrix3Xd path_m(3, 3);
  path_m.col(0) = Eigen::Vector3d(0.0, 0.062, 0.0);
  path_m.col(1) = Eigen::Vector3d(0.0, 0.031, 0.09);
  path_m.col(2) = Eigen::Vector3d(0.0, -0.02, 0.1);
  robot.cables[0].path_m = path_m;
  return robot;
}

TEST(Cables, FrictionRaisesTheTensionOnTheWayInAndLowersItOnTheWayOut) {
  const Effects friction = {Effect("cable_friction", {"cable:north"}, {{"mu", 0.4}})};
  const auto rough = Pulled(Routed(), {0.008, 0, 0, 0}, friction);
  const auto smooth = Pulled(Routed(), {0.008, 0, 0, 0});
  const double in_N = rough->cables()[0].tension_N;
  EXPECT_GT(in_N, 1.02 * smooth->cables()[0].tension_N);
  ASSERT_TRUE(rough->Advance(1.5, Commands({0.0045, 0, 0, 0})).ok());
  ASSERT_TRUE(smooth->Advance(1.5, Commands({0.0045, 0, 0, 0})).ok());
  EXPECT_LT(rough->cables()[0].tension_N, 0.98 * smooth->cables()[0].tension_N);
}

}  // namespace
}  // namespace palpate::virtual_robot::test
