// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "libs/robot/calibrated_geometry.hpp"
#include "libs/robot/compliance.hpp"
#include "libs/robot/frame_tracker.hpp"
#include "libs/robot/sensitivity/parameters.hpp"
#include "libs/robot/sensitivity/sensitivity_solver.hpp"
#include "tests/libs/robot/chambers/hollow_robot.hpp"

namespace palpate::robot {
namespace {

using testing::HasSubstr;

/// Actuators in the order cable top, chambers upper and lower.
class ChamberModel : public HollowRobotTest {
 protected:
  ChamberModel() : model_(Build(Text())), state_(model_->RestState()) {
    tip_ = fem::PointLocator(model_->body().mesh).Embed({0.06, 0.01, 0.01}).weights;
  }

  fem::StaticResult Reach(const std::vector<ActuatorCommand>& commands) {
    fem::StaticResult result = model_->Solve(commands, {}, &state_);
    EXPECT_TRUE(result.status.ok()) << result.status.message();
    return result;
  }
  double Pressure_Pa(int actuator) const {
    return model_->traits(actuator).ReportedForce(
        model_->StateOfActuator(actuator, state_).tension_N);
  }
  double Change_m3(int actuator) const {
    return model_->traits(actuator).ReportedDisplacement(
        model_->StateOfActuator(actuator, state_).displacement_m);
  }
  Eigen::Vector3d Tip_m() const { return tip_.Position(state_.x_m); }

  std::unique_ptr<RobotModel> model_;
  fem::StaticState state_;
  fem::InterpolationWeights tip_;
};

TEST_F(ChamberModel, PressureBendsAwayFromTheChamber) {
  Reach({{}, {}, {}});
  const double sag_m = Tip_m().z();
  Reach({{}, Pressure(*model_, 1, 8e3), {}});
  EXPECT_LT(Tip_m().z(), sag_m - 1e-4);
  EXPECT_GT(Change_m3(1), 1e-8);
  EXPECT_NEAR(Pressure_Pa(1), 8e3, 1e-8);
  Reach({{}, {}, Pressure(*model_, 2, 8e3)});
  EXPECT_GT(Tip_m().z(), sag_m + 1e-4);
}

TEST_F(ChamberModel, VolumeAndPressureLeadToTheSameBalance) {
  Reach({Displace(0.001), Pressure(*model_, 1, 6e3), Pressure(*model_, 2, 2e3)});
  const Eigen::VectorXd x_m = state_.x_m;
  const double upper_m3 = Change_m3(1), lower_m3 = Change_m3(2);
  state_ = model_->RestState();
  Reach({Displace(0.001), Volume(*model_, 1, upper_m3), Volume(*model_, 2, lower_m3)});
  EXPECT_LE((state_.x_m - x_m).norm(), 1e-8 * x_m.norm());
  EXPECT_NEAR(Pressure_Pa(1), 6e3, 0.01);
  EXPECT_NEAR(Pressure_Pa(2), 2e3, 0.01);
}

TEST_F(ChamberModel, AVolumeBelowRestNeedsAPressureBelowAmbient) {
  Reach({{}, Volume(*model_, 1, -2e-8), {}});
  EXPECT_LT(Pressure_Pa(1), -100.0);
  EXPECT_NEAR(Change_m3(1), -2e-8, 1e-13);
}

TEST_F(ChamberModel, AClosedChamberResistsALoad) {
  const std::vector<DeadLoad> push{{tip_, Eigen::Vector3d(0.0, 0.0, -0.2)}};
  ASSERT_TRUE(model_->Solve({{}, {}, {}}, push, &state_).status.ok());
  const double open_m = Tip_m().z();
  ASSERT_TRUE(model_->Solve({{}, Displace(0.0), Displace(0.0)}, push, &state_).status.ok());
  EXPECT_GT(Tip_m().z(), open_m);
  EXPECT_GT(std::abs(Pressure_Pa(1)), 1.0);
}

TEST_F(ChamberModel, RefusesPressuresOutsideOfTheSupplys) {
  const auto message = [&](const ActuatorCommand& upper) {
    fem::StaticState state = model_->RestState();
    return model_->Solve({{}, upper, {}}, {}, &state).status.message();
  };
  EXPECT_EQ(message(Pressure(*model_, 1, 30e3)),
            "chamber upper: pressure 30000 Pa is not within -101325 to 20000 Pa");
  EXPECT_THAT(message(Volume(*model_, 1, 3e-6)),
              HasSubstr("chamber upper: a change of volume of 3e-06 m3 needs more than "
                        "max_pressure_Pa (20000 Pa)"));
}

TEST_F(ChamberModel, CompliancesAreDerivativesOfReSolvedBalances) {
  const std::vector<ActuatorCommand> commands{Force(0.5), Pressure(*model_, 1, 6e3),
                                              Pressure(*model_, 2, 3e3)};
  Reach(commands);
  Eigen::Vector3d lambda_a_N;
  for (int a = 0; a < 3; ++a) lambda_a_N[a] = commands[static_cast<size_t>(a)].value;
  Compliance compliance(model_->linearisation(), RowsOfPoints({tip_}));
  compliance.SetForces({{tip_, Eigen::Vector3d::UnitZ()}});
  ASSERT_TRUE(
      model_->linearisation().Update(state_.x_m, lambda_a_N, state_.loads.external_force_N).ok());
  compliance.Compute(state_.x_m, model_->actuator_rest_m(), lambda_a_N, Eigen::VectorXd::Zero(1));
  EXPECT_LE((compliance.W_aa() - compliance.W_aa().transpose()).norm(),
            1e-9 * compliance.W_aa().norm());
  const fem::StaticState state = state_;
  const double step_N = 1e-4;
  for (int a = 0; a < 3; ++a) {
    const auto moved = [&](double by_N) {
      state_ = state;
      std::vector<ActuatorCommand> changed = commands;
      changed[static_cast<size_t>(a)].value += by_N;
      Reach(changed);
      Eigen::Matrix<double, 6, 1> values;
      values.head<3>() = Tip_m();
      for (int i = 0; i < 3; ++i) values[3 + i] = model_->actuator(i).Displacement_m(state_.x_m);
      return values;
    };
    const Eigen::Matrix<double, 6, 1> difference =
        (moved(step_N) - moved(-step_N)) / (2.0 * step_N);
    EXPECT_LE((compliance.W_ea().col(a) - difference.head<3>()).norm(),
              1e-5 * difference.head<3>().norm());
    EXPECT_LE((compliance.W_aa().col(a) - difference.tail<3>()).norm(),
              1e-5 * difference.tail<3>().norm());
  }
}

/// Derivatives of the tip with respect to offsets of the commands, volumes and pressures.
TEST_F(ChamberModel, SensitivitiesAreDerivativesOfReSolvedBalances) {
  const std::vector<ActuatorCommand> commands{Displace(0.001), Volume(*model_, 1, 6e-8),
                                              Pressure(*model_, 2, 3e3)};
  Reach(commands);
  std::vector<ParameterPtr> parameters;
  parameters.push_back(CableOffset(0));
  parameters.push_back(CableOffset(1));
  parameters.push_back(TensionOffset(2));
  SensitivitySolver sensitivity(*model_);
  const Status status = sensitivity.Compute(commands, state_, parameters);
  ASSERT_TRUE(status.ok()) << status.message();
  const Eigen::MatrixXd motion = sensitivity.PointMotion(tip_);
  const fem::StaticState state = state_;
  const std::vector<double> steps{1e-5, 1e-5, 1e-3};
  for (int p = 0; p < 3; ++p) {
    const auto index = static_cast<size_t>(p);
    const auto moved = [&](double by) {
      state_ = state;
      std::vector<ActuatorCommand> changed = commands;
      changed[index].value += by;
      Reach(changed);
      return Tip_m();
    };
    const Eigen::Vector3d difference =
        (moved(steps[index]) - moved(-steps[index])) / (2.0 * steps[index]);
    EXPECT_LE((motion.col(p) - difference).norm(), 1e-4 * difference.norm()) << p;
  }
}

/// A base that moves as a whole carries the walls of chambers along: the tip, too.
TEST_F(ChamberModel, ABaseCarriesChambersAlong) {
  const std::vector<ActuatorCommand> commands{
      {}, Volume(*model_, 1, 6e-8), Pressure(*model_, 2, 3e3)};
  Reach(commands);
  std::vector<ParameterPtr> parameters;
  parameters.push_back(
      BaseTranslation(Eigen::Vector3d::UnitY(), BaseRiders::kHeldNodesAndPullPoints));
  SensitivitySolver sensitivity(*model_);
  ASSERT_TRUE(sensitivity.Compute(commands, state_, parameters).ok());
  EXPECT_LE((sensitivity.PointMotion(tip_).col(0) - Eigen::Vector3d::UnitY()).norm(), 1e-8);
}

TEST_F(ChamberModel, AScaledBodyKeepsItsStrainsAtTheSamePressure) {
  RobotBody body = BodyOf(Text());
  body.gravity_m_s2.setZero();
  RobotModel one(body);
  ScaleBody(2.0, &body);
  RobotModel two(body);
  fem::StaticState state_one = one.RestState(), state_two = two.RestState();
  ASSERT_TRUE(one.Solve({{}, Pressure(one, 1, 6e3), {}}, {}, &state_one).status.ok());
  ASSERT_TRUE(two.Solve({{}, Pressure(two, 1, 6e3), {}}, {}, &state_two).status.ok());
  EXPECT_LE((2.0 * state_one.x_m - state_two.x_m).norm(), 1e-8 * state_two.x_m.norm());
}

TEST_F(ChamberModel, FramesFollowPressuresAndVolumes) {
  FrameTracker tracker(*model_, {});
  tracker.Start(state_);
  const Eigen::VectorXd no_force_N = Eigen::VectorXd::Zero(state_.x_m.size());
  std::vector<ActuatorCommand> commands;
  for (int frame = 1; frame <= 10; ++frame) {
    commands = {Displace(1e-4 * frame), Pressure(*model_, 1, 600.0 * frame),
                Volume(*model_, 2, 3e-9 * frame)};
    ASSERT_TRUE(tracker.Follow(commands, no_force_N).converged());
  }
  Reach(commands);
  EXPECT_LE((tracker.state().x_m - state_.x_m).norm(), 1e-7 * state_.x_m.norm());
}

}  // namespace
}  // namespace palpate::robot
