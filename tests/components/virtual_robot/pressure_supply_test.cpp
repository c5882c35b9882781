// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/virtual_robot/pressure_supply.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "tests/components/virtual_robot/bench_setup.hpp"
#include "tests/support/test_folder.hpp"

namespace palpate::virtual_robot::test {
namespace {

constexpr double kCommand_Pa = 20e3;
constexpr double kTau_s = 0.4;

/// Two chambers, of which the first has this supply.
PressureSupply SupplyOf(const scenario::ChamberSupply& first, const Effects& effects = {}) {
  std::vector<robot::BodyChamber> chambers(2);
  chambers[0].name = "tip";
  chambers[1].name = "base";
  scenario::Scenario scenario = PlainScenario();
  scenario.rest_between_s = 1.0;
  scenario.recordings.clear();
  for (const char* name : {"a", "b"}) {
    scenario::RecordingPlan& plan = scenario.recordings.emplace_back();
    plan.name = name;
    plan.duration_s = 2.0;
  }
  scenario.supply = {first};
  return {chambers, scenario, effects};
}

Eigen::VectorXd Both(double first_Pa, double second_Pa = 0.0) {
  return Eigen::Vector2d(first_Pa, second_Pa);
}

/// On to `t_s` with commands that go straight to these.
Eigen::VectorXd To(double t_s, const Eigen::VectorXd& command_Pa, PressureSupply* supply) {
  supply->Propose(t_s, command_Pa);
  supply->Commit();
  return supply->pressure_Pa();
}

TEST(PressureSupply, WithoutErrorsGivesTheCommand) {
  PressureSupply supply = SupplyOf({.chamber = "tip"});
  supply.Reset(0.0, Both(0.0));
  EXPECT_EQ(To(0.1, Both(kCommand_Pa, 5e3), &supply), Both(kCommand_Pa, 5e3));
}

TEST(PressureSupply, AStepOfTheValveIsAnExponential) {
  constexpr double kStep_s = 1e-9;
  PressureSupply supply = SupplyOf({.chamber = "tip", .valve_time_constant_s = kTau_s});
  supply.Reset(0.0, Both(0.0));
  To(kStep_s, Both(kCommand_Pa), &supply);
  for (const double t_s : {0.1, 0.35, 0.4, 1.7}) {
    const double expected_Pa = kCommand_Pa * (1.0 - std::exp(-t_s / kTau_s));
    EXPECT_NEAR(To(t_s, Both(kCommand_Pa), &supply)[0], expected_Pa, 1e-4);
  }
}

/// tau dp/dt + p = r t has p = r (t - tau + tau exp(-t / tau)).
TEST(PressureSupply, ARampIsFollowedAsFarBehindInOneStepAsInMany) {
  constexpr double kRate_Pa_s = 1e4;
  PressureSupply one = SupplyOf({.chamber = "tip", .valve_time_constant_s = kTau_s});
  PressureSupply many = one;
  one.Reset(0.0, Both(0.0));
  many.Reset(0.0, Both(0.0));
  constexpr double kEnd_s = 1.3;
  for (int k = 1; k < 40; ++k) {
    const double t_s = kEnd_s * k / 40;
    To(t_s, Both(kRate_Pa_s * t_s), &many);
  }
  const double expected_Pa = kRate_Pa_s * (kEnd_s - kTau_s + kTau_s * std::exp(-kEnd_s / kTau_s));
  EXPECT_NEAR(To(kEnd_s, Both(kRate_Pa_s * kEnd_s), &one)[0], expected_Pa, 1e-8 * kCommand_Pa);
  EXPECT_NEAR(To(kEnd_s, Both(kRate_Pa_s * kEnd_s), &many)[0], expected_Pa, 1e-8 * kCommand_Pa);
}

TEST(PressureSupply, ALeakTakesItsShareAndMakesTheValveFaster) {
  constexpr double kRatio = 0.25;
  PressureSupply supply =
      SupplyOf({.chamber = "tip", .valve_time_constant_s = kTau_s, .leak_ratio = kRatio});
  supply.Reset(0.0, Both(0.0));
  To(1e-9, Both(kCommand_Pa), &supply);
  const double end_Pa = kCommand_Pa / (1.0 + kRatio);
  const double t_s = 0.3;
  EXPECT_NEAR(To(t_s, Both(kCommand_Pa), &supply)[0],
              end_Pa * (1.0 - std::exp(-t_s * (1.0 + kRatio) / kTau_s)), 1e-4);
  EXPECT_NEAR(To(60.0, Both(kCommand_Pa), &supply)[0], end_Pa, 1e-9 * end_Pa);
  supply.Reset(0.0, Both(kCommand_Pa));
  EXPECT_DOUBLE_EQ(supply.pressure_Pa()[0], end_Pa);
}

TEST(PressureSupply, ZeroStaysZero) {
  PressureSupply supply = SupplyOf({.chamber = "tip",
                                    .valve_time_constant_s = kTau_s,
                                    .leak_ratio = 0.3,
                                    .sensor_gain = 0.1,
                                    .sensor_noise_Pa = 50.0});
  supply.Reset(0.0, Both(0.0));
  for (const double t_s : {0.01, 1.0, 100.0}) EXPECT_TRUE(To(t_s, Both(0.0), &supply).isZero(0.0));
}

TEST(PressureSupply, TheSensorHasGainAndZero) {
  PressureSupply supply =
      SupplyOf({.chamber = "tip", .sensor_gain = 0.05, .sensor_zero_Pa = -300.0},
               {Effect("pressure_gain", {"chamber:base"}, {{"g", -0.1}}),
                Effect("pressure_zero", {"chamber:tip"}, {{"zero_Pa", 100.0}})});
  supply.Reset(0.0, Both(kCommand_Pa, 1e4));
  EXPECT_NEAR(supply.pressure_Pa()[0], 1.05 * kCommand_Pa - 200.0, 1e-9);
  EXPECT_NEAR(supply.pressure_Pa()[1], 0.9e4, 1e-9);
}

TEST(PressureSupply, SwappedTubesFeedTheOtherChamber) {
  PressureSupply supply =
      SupplyOf({.chamber = "tip"}, {Effect("swapped_tubes", {"chamber:base", "chamber:tip"}, {})});
  supply.Reset(0.0, Both(kCommand_Pa, 0.0));
  EXPECT_EQ(supply.pressure_Pa(), Both(0.0, kCommand_Pa));
  EXPECT_EQ(supply.ChamberOfSupply(0), 1);
}

/// The second recording begins at 1 + 2 + 1 s.
TEST(PressureSupply, ABlockedValveKeepsThePressure) {
  constexpr double kBegin_s = 4.0;
  PressureSupply supply = SupplyOf(
      {.chamber = "tip"}, {Effect("blocked_valve", {"chamber:tip"}, {{"from_recording", 1}})});
  supply.Reset(0.0, Both(0.0));
  EXPECT_EQ(To(3.0, Both(3e3), &supply)[0], 3e3);
  EXPECT_NEAR(To(5.0, Both(5e3), &supply)[0], 1e3 * kBegin_s, 1e-9);
  EXPECT_NEAR(To(6.0, Both(0.0, 2e3), &supply)[0], 1e3 * kBegin_s, 1e-9);
  EXPECT_EQ(supply.pressure_Pa()[1], 2e3);
}

TEST(PressureSupply, AnOpenChamberBeginsAtAmbientPressure) {
  PressureSupply supply = SupplyOf({.chamber = "tip", .valve_time_constant_s = kTau_s});
  supply.Reset(0.0, Both(kNotDriven));
  EXPECT_TRUE(std::isnan(supply.pressure_Pa()[0]));
  EXPECT_NEAR(To(kTau_s, Both(kCommand_Pa), &supply)[0], kCommand_Pa * (1.0 - std::exp(-1.0)),
              1e-6);
}

TEST(PressureSupply, RefusesWhatTheRobotHasNot) {
  using testing::HasSubstr;
  EXPECT_THAT(test_support::MessageOf([] { SupplyOf({.chamber = "top"}); }),
              HasSubstr("no chamber 'top'"));
  EXPECT_THAT(test_support::MessageOf([] {
                SupplyOf({.chamber = "tip"}, {Effect("leak", {"chamber:top"}, {{"ratio", 0.1}})});
              }),
              HasSubstr("no 'chamber:top'"));
  EXPECT_THAT(test_support::MessageOf([] {
                SupplyOf({.chamber = "tip"},
                         {Effect("blocked_valve", {"chamber:tip"}, {{"from_recording", 2}})});
              }),
              HasSubstr("the last recording is 1"));
}

}  // namespace
}  // namespace palpate::virtual_robot::test
