// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/robot/sensitivity/point_sensitivity.hpp"

#include "tests/libs/robot/sensitivity/robot_case.hpp"

namespace palpate::robot {
namespace {

std::vector<fem::InterpolationWeights> MarkersOf(const RobotBody& body) {
  std::vector<fem::InterpolationWeights> markers;
  for (const BodyMarker& marker : body.markers) markers.push_back(marker.point.weights);
  return markers;
}

/// Of each kind: on the whole body, on the base, on few nodes, on a drive alone, on nothing.
std::vector<ParameterPtr> Many(const RobotBody& body) {
  const Eigen::Index size = 3 * body.mesh.NodeCount();
  std::vector<ParameterPtr> parameters;
  for (int k = 0; k < 10; ++k) parameters.push_back(GravityTurn(Eigen::Vector3d::Unit(k % 3)));
  parameters.push_back(YoungsModulus(1));
  parameters.push_back(BaseRotation(Eigen::Vector3d::UnitZ(), {0.0, 0.01, 0.01}));
  parameters.push_back(ExternalForce(body.markers[0].point.weights, Eigen::Vector3d::UnitY()));
  parameters.push_back(ExternalForce(body.markers[3].point.weights, Eigen::Vector3d::UnitZ()));
  for (int c = 0; c < 3; ++c) parameters.push_back(CableOffset(c));
  parameters.push_back(NodalForce(Eigen::VectorXd::Zero(size)));
  return parameters;
}

class OfPoints : public SensitivityCase {};

/// The laws of each kind of parameter are held against differences where that kind is tested, of
/// both methods.
TEST_P(OfPoints, AreThoseOfTheWholeBody) {
  for (const double mu : {0.0, 0.3}) {
    for (CableFriction& friction : robot_.friction) friction.coefficient = mu;
    Balance balance = Solve(robot_);
    const std::vector<fem::InterpolationWeights> markers = MarkersOf(robot_.body);
    const std::vector<ParameterPtr> parameters = Many(robot_.body);
    SensitivitySolver forward(*balance.model);
    ASSERT_TRUE(forward.Compute(robot_.cables, balance.state, parameters).ok());
    Eigen::MatrixXd motion_m;
    forward.PointMotions(markers, &motion_m);
    PointSensitivity adjoint(*balance.model, markers);
    for (const Factor factor : {Factor::kRenew, Factor::kPresent}) {
      ASSERT_TRUE(adjoint.Compute(robot_.cables, balance.state, parameters, factor).ok());
      ASSERT_EQ(adjoint.ParameterCount(), static_cast<int>(parameters.size()));
      for (Eigen::Index p = 0; p < motion_m.cols(); ++p) {
        const double scale = motion_m.col(p).norm();
        EXPECT_LE((adjoint.motion_m().col(p) - motion_m.col(p)).norm(), 1e-9 * scale) << p;
        EXPECT_LE((adjoint.length_m().col(p) - forward.length_m().col(p)).norm(), 1e-9 * scale);
        EXPECT_LE((adjoint.tension_N().col(p) - forward.tension_N().col(p)).norm(),
                  1e-9 * forward.tension_N().col(p).norm());
      }
    }
  }
}

TEST_P(OfPoints, OfAStateThatIsKnownNeedNoFactor) {
  for (CableFriction& friction : robot_.friction) friction.coefficient = 0.3;
  Balance balance = Solve(robot_);
  const std::vector<ParameterPtr> parameters = Many(robot_.body);
  PointSensitivity adjoint(*balance.model, MarkersOf(robot_.body));
  ASSERT_TRUE(adjoint.Compute(robot_.cables, balance.state, parameters).ok());
  const Eigen::MatrixXd motion_m = adjoint.motion_m();
  const Eigen::MatrixXd tension_N = adjoint.tension_N();
  const int factors = balance.model->linearisation().factor_count();
  const std::span<const ParameterPtr> last = std::span(parameters).last(5);
  ASSERT_TRUE(adjoint.ComputeAgain(robot_.cables, balance.state, last).ok());
  EXPECT_EQ(adjoint.motion_m(), motion_m.rightCols(5));
  EXPECT_EQ(adjoint.tension_N(), tension_N.rightCols(5));
  EXPECT_EQ(balance.model->linearisation().factor_count(), factors);
}

/// A force at one point moves another as a force there moves the first (Maxwell, Betti), and so do
/// both methods in turn.
TEST_P(OfPoints, MoveEachOtherAlike) {
  Balance balance = Solve(robot_);
  const std::vector<fem::InterpolationWeights> markers = MarkersOf(robot_.body);
  std::vector<ParameterPtr> forces;
  for (const fem::InterpolationWeights& marker : markers) {
    for (int i = 0; i < 3; ++i) forces.push_back(ExternalForce(marker, Eigen::Vector3d::Unit(i)));
  }
  PointSensitivity adjoint(*balance.model, markers);
  ASSERT_TRUE(adjoint.Compute(robot_.cables, balance.state, forces).ok());
  const Eigen::MatrixXd& compliance_m_N = adjoint.motion_m();
  EXPECT_LE((compliance_m_N - compliance_m_N.transpose()).norm(), 1e-10 * compliance_m_N.norm());
  EXPECT_GT(compliance_m_N.diagonal().minCoeff(), 0.0);
}

INSTANTIATE_TEST_SUITE_P(SoftBeam, OfPoints, AllCases());

TEST(PointSensitivity, SaysWhereThereIsNoFactorAndGivesNoNumbers) {
  const RobotCase robot = SoftBeam({fem::ElementType::kTet4, Control::kTension});
  const Balance balance = Solve(robot);
  fem::StaticState unstable = balance.state;
  unstable.multipliers_N.setConstant(-1e3);  // pushing cables
  PointSensitivity adjoint(*balance.model, MarkersOf(robot.body));
  const std::vector<ParameterPtr> parameters = Many(robot.body);
  ASSERT_TRUE(adjoint.Compute(robot.cables, balance.state, parameters).ok());
  EXPECT_EQ(adjoint.Compute(robot.cables, unstable, parameters).code(),
            StatusCode::kNotPositiveDefinite);
  EXPECT_EQ(adjoint.ParameterCount(), 0);
  EXPECT_EQ(adjoint.length_m().cols(), 0);
  EXPECT_EQ(adjoint.tension_N().cols(), 0);
}

TEST(PointSensitivity, RefusesCablesThatActAlike) {
  RobotCase robot = SoftBeam({fem::ElementType::kTet4, Control::kTension});
  robot.body.cables[1] = robot.body.cables[0];
  const Balance balance = Solve(robot);
  const ActuatorCommand hold{ActuatorCommand::Kind::kDisplacement, 0.0};
  PointSensitivity adjoint(*balance.model, MarkersOf(robot.body));
  EXPECT_EQ(adjoint.Compute({hold, hold, {}}, balance.state, Many(robot.body)).code(),
            StatusCode::kUnobservable);
  EXPECT_EQ(adjoint.ParameterCount(), 0);
}

}  // namespace
}  // namespace palpate::robot
