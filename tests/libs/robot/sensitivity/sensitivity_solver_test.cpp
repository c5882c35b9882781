// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/robot/sensitivity/sensitivity_solver.hpp"

#include <Eigen/Geometry>
#include <limits>

#include "tests/libs/robot/sensitivity/robot_case.hpp"

namespace palpate::robot {
namespace {

class SolverOfSensitivities : public SensitivityCase {
 protected:
  std::vector<ParameterPtr> Several() const {
    std::vector<ParameterPtr> parameters;
    parameters.push_back(YoungsModulus(0));
    parameters.push_back(CableOffset(0));
    parameters.push_back(BaseRotation(Eigen::Vector3d::UnitY(), {0.0, 0.01, 0.01}));
    parameters.push_back(GravityTurn(Eigen::Vector3d::UnitX()));
    parameters.push_back(PullPointMove(1, Eigen::Vector3d::UnitZ()));
    parameters.push_back(
        ExternalForce(robot_.body.markers[0].point.weights, Eigen::Vector3d::UnitY()));
    return parameters;
  }
};

TEST_P(SolverOfSensitivities, AFurtherParameterChangesNoOther) {
  for (const double mu : {0.0, 0.3}) {
    robot_.friction[0].coefficient = mu;
    Balance balance = Solve(robot_);
    SensitivitySolver solver(*balance.model);
    const std::vector<ParameterPtr> together = Several();
    ASSERT_TRUE(solver.Compute(robot_.cables, balance.state, together).ok());
    ASSERT_EQ(solver.ParameterCount(), 6);
    std::vector<ParameterPtr> alone = Several();
    for (int p = 0; p < 6; ++p) {
      const Derivative one =
          Differentiate(balance, robot_, std::move(alone[static_cast<size_t>(p)]));
      for (size_t m = 0; m < robot_.body.markers.size(); ++m) {
        const Eigen::Vector3d point =
            solver.PointMotion(robot_.body.markers[m].point.weights).col(p);
        EXPECT_LE((point - one.points_m.segment<3>(static_cast<Eigen::Index>(3 * m))).norm(),
                  1e-10 * one.points_m.norm());
      }
      EXPECT_LE((solver.length_m().col(p) - one.lengths_m).norm(), 1e-10 * one.points_m.norm());
      EXPECT_LE((solver.tension_N().col(p) - one.tensions_N).norm(), 1e-10 * one.tensions_N.norm());
    }
  }
}

TEST_P(SolverOfSensitivities, PointsMoveWithTheirNodes) {
  Balance balance = Solve(robot_);
  SensitivitySolver solver(*balance.model);
  ASSERT_TRUE(solver.Compute(robot_.cables, balance.state, Several()).ok());
  // One that holds on to held and free nodes alike.
  const fem::InterpolationWeights& point = robot_.body.markers[3].point.weights;
  const Eigen::Matrix3Xd motion = solver.PointMotion(point);
  Eigen::VectorXd nodal;
  for (int p = 0; p < solver.ParameterCount(); ++p) {
    solver.NodalMotion(p, &nodal);
    EXPECT_LE((point.Position(nodal) - motion.col(p)).norm(), 1e-14 * (1.0 + motion.norm()));
    for (int c = 0; c < 3; ++c) {
      const Cable& cable = balance.model->cable(c);
      Eigen::VectorXd gradient = Eigen::VectorXd::Zero(nodal.size());
      cable.AddGradient(balance.state.x_m, 1.0, gradient);
      if (p == 4 && c == 1) continue;  // its pull point moves
      EXPECT_NEAR(gradient.dot(nodal), solver.length_m()(c, p), 1e-10 * (1e-3 + nodal.norm()));
    }
  }
}

TEST_P(SolverOfSensitivities, ACableKeepsWhatItsDriveKeeps) {
  Balance balance = Solve(robot_);
  SensitivitySolver solver(*balance.model);
  ASSERT_TRUE(solver.Compute(robot_.cables, balance.state, Several()).ok());
  for (int c = 0; c < 3; ++c) {
    const bool taut = balance.Tensions_N()[c] > 0.0;
    const bool displaced =
        robot_.cables[static_cast<size_t>(c)].kind == ActuatorCommand::Kind::kDisplacement;
    for (const int p : {0, 2, 3, 5}) {
      if (taut && displaced) {
        EXPECT_NEAR(solver.length_m()(c, p), 0.0, 1e-12);
        EXPECT_NE(solver.tension_N()(c, p), 0.0);
      } else {
        EXPECT_NE(solver.length_m()(c, p), 0.0);
        EXPECT_EQ(solver.tension_N()(c, p), 0.0);
      }
    }
  }
}

TEST_P(SolverOfSensitivities, TheFactorOfTheStaticSolverServes) {
  Balance balance = Solve(robot_);
  SensitivitySolver solver(*balance.model);
  ASSERT_TRUE(solver.Compute(robot_.cables, balance.state, Several(), Factor::kPresent).ok());
  const fem::InterpolationWeights& point = robot_.body.markers[0].point.weights;
  const Eigen::Matrix3Xd present = solver.PointMotion(point);
  ASSERT_TRUE(solver.Compute(robot_.cables, balance.state, Several(), Factor::kRenew).ok());
  EXPECT_LE((solver.PointMotion(point) - present).norm(), 1e-12 * present.norm());
}

INSTANTIATE_TEST_SUITE_P(SoftBeam, SolverOfSensitivities, AllCases());

TEST(SensitivitySolver, RefusesCablesThatActAlike) {
  RobotCase robot = SoftBeam({fem::ElementType::kTet4, Control::kTension});
  robot.body.cables[1] = robot.body.cables[0];
  const Balance balance = Solve(robot);
  SensitivitySolver solver(*balance.model);
  const ActuatorCommand hold{ActuatorCommand::Kind::kDisplacement, 0.0};
  std::vector<ParameterPtr> parameters;
  parameters.push_back(YoungsModulus(0));
  EXPECT_EQ(solver.Compute({hold, hold, {}}, balance.state, parameters).code(),
            StatusCode::kUnobservable);
  EXPECT_EQ(solver.ParameterCount(), 0);
}

TEST(SensitivitySolverDeathTest, RefusesIndicesThatAreNotThere) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const RobotCase robot = SoftBeam({fem::ElementType::kTet4, Control::kDisplacement});
  Balance balance = Solve(robot);
  EXPECT_DEATH(Differentiate(balance, robot, YoungsModulus(2)), "material_");
  EXPECT_DEATH(Differentiate(balance, robot, CableOffset(3)), "actuator");
  EXPECT_DEATH(Differentiate(balance, robot, EyeletMove(0, 3, robot.body.markers[0].point.weights)),
               "eyelet_");
}

/// Its drive yields there: the tension stays, as under force control.
TEST(SensitivitySolver, ACableAtItsTensionLimitKeepsItsTension) {
  RobotCase robot = SoftBeam({fem::ElementType::kTet4, Control::kTension});
  robot.body.cables[0].max_tension_N = robot.cables[0].value;
  Balance balance = Solve(robot);
  const Derivative by_tension = Differentiate(balance, robot, YoungsModulus(0));
  robot.cables[0] = {ActuatorCommand::Kind::kDisplacement, 0.1};
  const Derivative at_limit = Differentiate(balance, robot, YoungsModulus(0));
  EXPECT_EQ(at_limit.tensions_N[0], 0.0);
  EXPECT_NE(at_limit.lengths_m[0], 0.0);
  EXPECT_LE((at_limit.points_m - by_tension.points_m).norm(), 1e-12 * by_tension.points_m.norm());
  EXPECT_EQ(Differentiate(balance, robot, CableOffset(0)).points_m.norm(), 0.0);
}

TEST(SensitivitySolver, SaysWhereThereIsNoFactorAndGivesNoNumbers) {
  const RobotCase robot = SoftBeam({fem::ElementType::kTet4, Control::kTension});
  const Balance balance = Solve(robot);
  fem::StaticState state = balance.state;
  state.multipliers_N.setConstant(-1e3);  // pushing cables: unstable
  SensitivitySolver solver(*balance.model);
  std::vector<ParameterPtr> parameters;
  parameters.push_back(YoungsModulus(0));
  const fem::InterpolationWeights& point = robot.body.markers[0].point.weights;
  ASSERT_TRUE(solver.Compute(robot.cables, balance.state, parameters).ok());
  ASSERT_EQ(solver.PointMotion(point).cols(), 1);
  EXPECT_EQ(solver.Compute(robot.cables, state, parameters).code(),
            StatusCode::kNotPositiveDefinite);
  EXPECT_EQ(solver.ParameterCount(), 0);
  EXPECT_EQ(solver.PointMotion(point).cols(), 0);
  EXPECT_EQ(solver.length_m().cols(), 0);
  EXPECT_EQ(solver.tension_N().cols(), 0);
}

TEST(SensitivitySolver, RefusesAStateThatIsNotFinite) {
  const RobotCase robot = SoftBeam({fem::ElementType::kTet4, Control::kTension});
  const Balance balance = Solve(robot);
  fem::StaticState state = balance.state;
  state.x_m[30] = std::numeric_limits<double>::quiet_NaN();
  SensitivitySolver solver(*balance.model);
  EXPECT_FALSE(solver.Compute(robot.cables, state, {}).ok());
}

}  // namespace
}  // namespace palpate::robot
