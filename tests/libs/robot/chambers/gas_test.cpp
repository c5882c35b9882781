// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "libs/robot/solve_with_gas.hpp"
#include "tests/libs/robot/chambers/hollow_robot.hpp"

namespace palpate::robot {
namespace {

using testing::HasSubstr;

TEST(GasLaw, KeepsPressureTimesVolume) {
  const GasLaw law(2e-6, 1e-6, 0.5e-6);
  for (const double change_m3 : {-1e-6, 0.0, 3e-6}) {
    const double pressure_Pa = law.Pressure_Pa(change_m3);
    EXPECT_NEAR((kAmbient_Pa + pressure_Pa) * (3e-6 + change_m3), kAmbient_Pa * 3.5e-6, 1e-15);
    EXPECT_NEAR(law.Change_m3(pressure_Pa), change_m3, 1e-20);
    const double step_Pa = 1.0;
    EXPECT_NEAR(law.Compliance_m3_Pa(pressure_Pa),
                (law.Change_m3(pressure_Pa - step_Pa) - law.Change_m3(pressure_Pa + step_Pa)) /
                    (2.0 * step_Pa),
                1e-8 * law.Compliance_m3_Pa(pressure_Pa));
  }
}

/// Actuators in the order cable top, chambers upper (1 cm3 of tube) and lower (none).
class GasInChambers : public HollowRobotTest {
 protected:
  GasInChambers() : model_(Build(Text())), state_(model_->RestState()) {}

  fem::StaticResult Reach(const std::vector<ChamberGas>& gas, const GasSolveTuning& tuning = {}) {
    fem::StaticResult result = SolveWithGas(*model_, {{}, {}, {}}, gas, {}, &state_, tuning);
    EXPECT_TRUE(result.status.ok()) << result.status.message();
    return result;
  }
  double Pressure_Pa(int actuator) const {
    return model_->traits(actuator).ReportedForce(state_.multipliers_N[actuator]);
  }
  double Change_m3(int actuator) const {
    return model_->traits(actuator).ReportedDisplacement(
        model_->StateOfActuator(actuator, state_).displacement_m);
  }
  double Rest_m3(int actuator) const {
    return model_->body().chambers.at(At(actuator - 1)).volume_m3;
  }

  std::unique_ptr<RobotModel> model_;
  fem::StaticState state_;
};

TEST_F(GasInChambers, FollowsBoyle) {
  fem::StaticSettings exact;
  exact.constraint_tolerance_m = 1e-13;
  model_ = Build(Text(), exact);
  GasSolveTuning tuning;
  tuning.relative_tolerance = 1e-10;
  for (const double air_m3 : {1e-7, 2e-7, -1e-7, 0.0}) {
    Reach({{.actuator = 1, .air_m3 = air_m3}, {.actuator = 2, .air_m3 = 0.5 * air_m3}}, tuning);
    const double upper_J = (kAmbient_Pa + Pressure_Pa(1)) * (Rest_m3(1) + 1e-6 + Change_m3(1));
    const double lower_J = (kAmbient_Pa + Pressure_Pa(2)) * (Rest_m3(2) + Change_m3(2));
    EXPECT_NEAR(upper_J / (kAmbient_Pa * (Rest_m3(1) + 1e-6 + air_m3)), 1.0, 1e-8);
    EXPECT_NEAR(lower_J / (kAmbient_Pa * (Rest_m3(2) + 0.5 * air_m3)), 1.0, 1e-8);
    if (air_m3 > 0.0) {
      EXPECT_GT(Pressure_Pa(1), 100.0);
    }
    if (air_m3 < 0.0) {
      EXPECT_LT(Pressure_Pa(1), -100.0);
    }
  }
}

TEST_F(GasInChambers, IsTheBalanceOfThePressureThatItHas) {
  Reach({{.actuator = 1, .air_m3 = 2e-7}});
  const Eigen::VectorXd x_m = state_.x_m;
  const double pressure_Pa = Pressure_Pa(1);
  state_ = model_->RestState();
  ASSERT_TRUE(model_->Solve({{}, Pressure(*model_, 1, pressure_Pa), {}}, {}, &state_).status.ok());
  EXPECT_LE((state_.x_m - x_m).norm(), 1e-8 * x_m.norm());
}

TEST_F(GasInChambers, ALargeTubeHoldsThePressure) {
  std::string text = Text();
  text.replace(text.find("dead_volume_m3: 1e-6"), 20, "dead_volume_m3: 10.0");
  model_ = Build(text);
  state_ = model_->RestState();
  Reach({{.actuator = 1, .air_m3 = 10.0 * 8e3 / kAmbient_Pa}});
  EXPECT_NEAR(Pressure_Pa(1), 8e3, 0.1);
}

TEST_F(GasInChambers, AFluidThatDoesNotYieldHoldsTheVolume) {
  Reach({{.actuator = 1, .air_m3 = 1e-7, .ambient_Pa = 1e15}});
  EXPECT_NEAR(Change_m3(1), 1e-7, 1e-13);
  const double pressure_Pa = Pressure_Pa(1);
  state_ = model_->RestState();
  ASSERT_TRUE(model_->Solve({{}, Volume(*model_, 1, 1e-7), {}}, {}, &state_).status.ok());
  EXPECT_NEAR(Pressure_Pa(1), pressure_Pa, 1e-4 * pressure_Pa);
}

TEST_F(GasInChambers, PressuresConvergeQuadratically) {
  GasSolveTuning tuning;
  tuning.relative_tolerance = 1e-9;
  tuning.most_iterations = 4;
  const fem::StaticResult result =
      SolveWithGas(*model_, {{}, {}, {}}, {{.actuator = 1, .air_m3 = 2e-7}}, {}, &state_, tuning);
  EXPECT_TRUE(result.status.ok()) << result.status.message();
}

TEST_F(GasInChambers, RefusesWhatHoldsNoGasAndWhatIsTooMuch) {
  const auto refused = [&](const ChamberGas& gas) {
    fem::StaticState state = model_->RestState();
    const Eigen::VectorXd x_m = state.x_m;
    const Status status = SolveWithGas(*model_, {{}, {}, {}}, {gas}, {}, &state).status;
    EXPECT_FALSE(status.ok());
    EXPECT_EQ(state.x_m, x_m);
    return status;
  };
  EXPECT_THAT(refused({.actuator = 0, .air_m3 = 1e-7}).message(), HasSubstr("is no chamber"));
  EXPECT_THAT(refused({.actuator = 3, .air_m3 = 1e-7}).message(), HasSubstr("is no chamber"));
  EXPECT_THAT(refused({.actuator = 1, .air_m3 = -1e-3}).message(),
              HasSubstr("chamber upper cannot lose 0.001 m3 of air"));
  const Status limit = refused({.actuator = 1, .air_m3 = 1e-5});
  EXPECT_EQ(limit.code(), StatusCode::kTensionLimit);
  EXPECT_EQ(limit.message(), "chamber upper: its air needs more than max_pressure_Pa (20000 Pa)");
}

}  // namespace
}  // namespace palpate::robot
