// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "libs/core/error.hpp"
#include "tests/components/virtual_robot/bench_setup.hpp"
#include "tests/support/robots.hpp"

namespace palpate::virtual_robot::test {
namespace {

scenario::Scenario WithFinger() {
  scenario::Scenario scenario = PlainScenario();
  scenario.tools.resize(1);
  scenario.tools[0].name = "finger";
  scenario.tools[0].radius_m = 0.01;
  return scenario;
}

void ExpectRefused(const Effects& effects, const std::string& reason) {
  try {
    const VirtualRobot robot(test_support::LinearFourLegRobot(), PlainScenario(), effects, 1);
    ADD_FAILURE() << reason;
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find(reason), std::string::npos) << error.what();
  }
}

TEST(Refusals, OfEffectsThatDoNotFit) {
  ExpectRefused({Effect("levitation", {"body"}, {})}, "levitation");
  ExpectRefused({Effect("cable_gain", {"cable:up"}, {{"g", 0.1}})}, "cable:up");
  ExpectRefused({Effect("swapped_cables", {"cable:north"}, {})}, "expected is 2");
  ExpectRefused({Effect("backlash", {"cable:north"}, {{"play_m", -1.0}})}, "play_m");
  ExpectRefused({Effect("lag", {"body"}, {{"delay_s", 0.1}})}, "tau_s");
  ExpectRefused({Effect("poissons_ratio", {"body"}, {{"nu", 0.6}})}, "0.6");
  ExpectRefused({Effect("youngs_modulus", {"body"}, {{"factor", 0.0}})}, "factor");
  ExpectRefused({Effect("cable_elasticity", {"cable:north"}, {{"k_N_m", 0.0}})}, "k_N_m");
}

TEST(Refusals, OfABodyThatCannotBe) {
  const auto refused = [](const std::function<void(scenario::BodyTruth*)>& change) {
    scenario::Scenario scenario = PlainScenario();
    change(&scenario.body);
    EXPECT_THROW(VirtualRobot(test_support::LinearFourLegRobot(), scenario, {}, 1), InputError);
  };
  refused([](scenario::BodyTruth* body) { body->refine = 3; });
  refused([](scenario::BodyTruth* body) { body->element = "hex8"; });
  refused([](scenario::BodyTruth* body) { body->material_model = "jelly"; });
  refused([](scenario::BodyTruth* body) { body->material_model = "linear"; });
  refused([](scenario::BodyTruth* body) { body->prony = {{-0.1, 1.0}}; });
}

TEST(Refusals, OfInputsKeepTheState) {
  VirtualRobot robot(test_support::LinearFourLegRobot(), WithFinger(), {}, 1);
  const Inputs still = Commands({0, 0, 0, 0});
  EXPECT_EQ(robot.Advance(0.1, still).code(), StatusCode::kNotRun);
  ASSERT_TRUE(robot.Start(1.0, still).ok());
  const Eigen::VectorXd before_m = robot.positions_m();
  const auto refused = [&](double t_s, const Inputs& inputs) {
    EXPECT_EQ(robot.Advance(t_s, inputs).code(), StatusCode::kInvalidInput);
    EXPECT_EQ(robot.positions_m(), before_m);
    EXPECT_EQ(robot.time_s(), 1.0);
  };
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  refused(1.0, still);
  refused(kNan, still);
  refused(1.1, Commands({0, 0, 0}));
  refused(1.1, Commands({std::numeric_limits<double>::infinity(), 0, 0, 0}));
  Inputs inputs = still;
  inputs.tools = {At("finger", {kNan, 0, 0})};
  refused(1.1, inputs);
  inputs.tools = {At("hammer", {0, 0, 1})};
  refused(1.1, inputs);
  inputs.tools = {At("finger", {0, 0, 1}), At("finger", {0, 0, 1})};
  refused(1.1, inputs);
  inputs = still;
  inputs.weights = {Weight({0, 0, 0.12}, -1.0)};
  refused(1.1, inputs);
  inputs = still;
  inputs.base_tilt_deg.x() = kNan;
  refused(1.1, inputs);
  EXPECT_TRUE(robot.Advance(1.1, still).ok());
}

TEST(Failure, LeavesTheLastGoodState) {
  VirtualRobot robot(test_support::LinearFourLegRobot(), PlainScenario(), {}, 1);
  ASSERT_TRUE(robot.Start(0.0, Commands({0, 0, 0, 0})).ok());
  Inputs crushed = Commands({0, 0, 0, 0});
  crushed.weights = {Weight({0, 0, 0.125}, 200.0, 0.005)};
  const Status status = robot.Advance(0.05, crushed);
  ASSERT_FALSE(status.ok());
  EXPECT_FALSE(status.message().empty());
  EXPECT_TRUE(robot.positions_m().allFinite());
  EXPECT_LT(robot.time_s(), 0.05);
  const double reached_s = robot.time_s();
  EXPECT_TRUE(robot.Start(reached_s, Commands({0, 0, 0, 0})).ok());
}

TEST(Determinism, TheSameInputsGiveTheSameBits) {
  const auto run = [] {
    scenario::Scenario scenario = WithFinger();
    scenario.motion = {scenario::MotionMode::kDynamic, 1.0 / 60.0, 1.0, 1e-3};
    scenario.tools[0].friction_coefficient = 0.5;
    VirtualRobot robot(test_support::LinearFourLegRobot(), scenario,
                       {Effect("viscoelastic_creep", {"body"}, {{"g", 0.2}, {"tau_s", 1.0}})}, 9);
    Inputs inputs = Commands({0, 0, 0, 0});
    inputs.tools = {At("finger", {0, 0, 0.14})};
    EXPECT_TRUE(robot.Start(0.0, inputs).ok());
    for (int k = 1; k <= 10; ++k) {
      inputs.displacement_m[0] = 5e-4 * k;
      inputs.tools = {At("finger", {0, 0, 0.14 - 0.001 * k})};
      EXPECT_TRUE(robot.Advance(k / 30.0, inputs).ok());
    }
    return Eigen::VectorXd(robot.positions_m());
  };
  EXPECT_EQ(run(), run());
}

TEST(Discretisation, IsTheScenariosOwn) {
  scenario::Scenario scenario = PlainScenario();
  const VirtualRobot coarse(test_support::LinearFourLegRobot(), scenario, {}, 1);
  scenario.body.refine = 1;
  const VirtualRobot fine(test_support::LinearFourLegRobot(), scenario, {}, 1);
  EXPECT_EQ(fine.mesh().CellCount(), 8 * coarse.mesh().CellCount());
  EXPECT_NE(fine.mesh_hash(), coarse.mesh_hash());
  scenario.body.refine = 0;
  scenario.body.element = "tet10";
  const VirtualRobot quadratic(test_support::LinearFourLegRobot(), scenario, {}, 1);
  EXPECT_EQ(quadratic.mesh().cells.rows(), 10);
}

}  // namespace
}  // namespace palpate::virtual_robot::test
