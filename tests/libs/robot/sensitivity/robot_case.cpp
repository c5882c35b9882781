// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/libs/robot/sensitivity/robot_case.hpp"

#include <algorithm>

#include "libs/fem/shape_functions.hpp"
#include "libs/robot/sensitivity/point_sensitivity.hpp"
#include "tests/libs/fem/points/meshes.hpp"
#include "tests/support/robots.hpp"

namespace palpate::robot {

namespace {

constexpr double kGuideRadius_m = 0.0015;

std::vector<ActuatorCommand> Commands(Control control) {
  const auto displace = [](double value) {
    return ActuatorCommand{ActuatorCommand::Kind::kDisplacement, value};
  };
  const auto pull = [](double value) {
    return ActuatorCommand{ActuatorCommand::Kind::kTension, value};
  };
  switch (control) {
    case Control::kDisplacement: return {displace(0.005), displace(0.007), displace(0.006)};
    case Control::kTension: return {pull(0.5), pull(0.3), pull(0.4)};
    case Control::kMixed: return {displace(0.005), pull(0.2), displace(-0.02)};
  }
  return {};
}

void ExpectAlike(const Eigen::MatrixXd& one, const Eigen::MatrixXd& other) {
  constexpr double kRounding = 1e-12;  // of what cancels where everything moves along by 1 m/m
  ASSERT_EQ(one.cols(), other.cols());
  EXPECT_LE((one - other).norm(), 1e-9 * other.norm() + kRounding) << one << "\n\n" << other;
}

double NormOr(const Eigen::VectorXd& vector, double least) {
  return std::max(vector.norm(), least);
}

}  // namespace

void PrintTo(const CaseKind& kind, std::ostream* out) {
  *out << (kind.element == fem::ElementType::kTet4 ? "tet4" : "tet10");
  *out << (kind.control == Control::kDisplacement ? " displacement"
           : kind.control == Control::kTension    ? " tension"
                                                  : " mixed");
}

GuidePlan SoftBeamGuides() {
  GuidePlan plan{{Eigen::Matrix3Xd(3, 3), Eigen::Matrix3Xd(3, 2), Eigen::Matrix3Xd(3, 2)},
                 kGuideRadius_m};
  plan.eyelets_m[0] << 0.031, 0.062, 0.094,  //
      0.0091, 0.0118, 0.0093,                //
      0.0187, 0.0179, 0.0203;
  plan.eyelets_m[1] << 0.047, 0.093,  //
      0.0142, 0.0117,                 //
      0.0013, 0.0021;
  plan.eyelets_m[2] << 0.038, 0.087,  //
      0.0012, 0.0019,                 //
      0.0108, 0.0131;
  return plan;
}

RobotCase SoftBeam(const CaseKind& kind) {
  const bool quadratic = kind.element == fem::ElementType::kTet10;
  RobotCase robot;
  RobotBody& body = robot.body;
  body.mesh = fem::BoxMesh({0.1, 0.02, 0.02}, {quadratic ? 4 : 6, 2, 2});
  if (quadratic) body.mesh = fem::MakeQuadratic(body.mesh);
  const auto volumetric =
      quadratic ? fem::Volumetric::kMeanDilatation : fem::Volumetric::kPointwise;
  test_support::MakeTwoMaterialBeam({fem::MaterialModel::kStableNeoHookean, volumetric, 65e3, 0.45},
                                    {fem::MaterialModel::kNeoHookean, volumetric, 45e3, 0.42},
                                    &body);
  body.gravity_m_s2 = {1.0, 2.0, -9.5};
  const fem::PointLocator locator(body.mesh);
  const std::vector<Eigen::Vector3d> pull_points_m{
      {-0.01, 0.011, 0.026}, {-0.008, 0.013, -0.004}, {-0.012, -0.003, 0.008}};
  const GuidePlan guides = SoftBeamGuides();
  for (size_t c = 0; c < pull_points_m.size(); ++c) {
    BodyCable cable{"cable", pull_points_m[c], {}, 50.0, 0.0, guides.radius_m};
    for (const auto& eyelet_m : guides.eyelets_m[c].colwise()) {
      cable.eyelets.push_back(locator.EmbedBall(eyelet_m, guides.radius_m));
    }
    body.cables.push_back(cable);
  }
  for (const Eigen::Vector3d& marker_m :
       {Eigen::Vector3d(0.1, 0.01, 0.01), Eigen::Vector3d(0.07, 0.02, 0.013),
        Eigen::Vector3d(0.035, 0.004, 0.022), Eigen::Vector3d(0.009, 0.01, 0.004)}) {
    body.markers.push_back({"marker", locator.Embed(marker_m)});
  }
  robot.cables = Commands(kind.control);
  robot.loads = {{body.markers[1].point.weights, {0.01, 0.05, -0.02}}};
  robot.held_motion_m = Eigen::VectorXd::Zero(3 * body.mesh.NodeCount());
  robot.friction.resize(robot.cables.size());
  robot.compliance_m_N = Eigen::VectorXd::Zero(std::ssize(robot.cables));
  return robot;
}

double RestLength_m(const RobotBody& body, size_t cable) {
  std::vector<fem::InterpolationWeights> eyelets;
  for (const fem::BodyPoint& eyelet : body.cables[cable].eyelets) eyelets.push_back(eyelet.weights);
  return Cable(body.cables[cable].pull_point_m, eyelets, body.mesh.nodes_m.reshaped())
      .rest_length_m();
}

Balance Solve(const RobotCase& robot, const fem::StaticState* start) {
  Balance balance;
  balance.model = std::make_unique<RobotModel>(
      robot.body,
      fem::StaticSettings{.relative_tolerance = 1e-13, .constraint_tolerance_m = 1e-14});
  for (int c = 0; c < balance.model->ActuatorCount(); ++c) {
    balance.model->SetCableFriction(c, robot.friction[static_cast<size_t>(c)]);
    balance.model->SetCableCompliance(c, robot.compliance_m_N[c]);
  }
  balance.state = start != nullptr ? *start : balance.model->RestState();
  fem::LoadState loads = balance.model->Loads(robot.cables, robot.loads);
  loads.fixed_position_m += robot.held_motion_m;
  const fem::StaticResult result = balance.model->static_solver().Solve(loads, &balance.state);
  EXPECT_TRUE(result.status.ok()) << ToString(result.status.code()) << ": "
                                  << result.status.message() << ", residual "
                                  << result.residual_relative;
  return balance;
}

Eigen::VectorXd Balance::Points_m() const {
  Eigen::VectorXd points_m(static_cast<Eigen::Index>(3 * model->body().markers.size()));
  for (size_t m = 0; m < model->body().markers.size(); ++m) {
    points_m.segment<3>(static_cast<Eigen::Index>(3 * m)) =
        model->body().markers[m].point.weights.Position(state.x_m);
  }
  return points_m;
}

Eigen::VectorXd Balance::Lengths_m() const {
  Eigen::VectorXd lengths_m(model->ActuatorCount());
  for (int c = 0; c < model->ActuatorCount(); ++c) {
    lengths_m[c] = model->StateOfActuator(c, state).length_m;
  }
  return lengths_m;
}

Derivative Differentiate(Balance& balance, const RobotCase& robot, ParameterPtr parameter) {
  SensitivitySolver solver(*balance.model);
  std::vector<ParameterPtr> parameters;
  parameters.push_back(std::move(parameter));
  const Status status = solver.Compute(robot.cables, balance.state, parameters);
  EXPECT_TRUE(status.ok()) << status.message();
  std::vector<fem::InterpolationWeights> markers;
  for (const BodyMarker& marker : balance.model->body().markers) {
    markers.push_back(marker.point.weights);
  }
  Eigen::MatrixXd motions_m;
  solver.PointMotions(markers, &motions_m);
  PointSensitivity adjoint(*balance.model, markers);
  EXPECT_TRUE(adjoint.Compute(robot.cables, balance.state, parameters).ok());
  ExpectAlike(adjoint.motion_m(), motions_m);
  ExpectAlike(adjoint.length_m(), solver.length_m());
  ExpectAlike(adjoint.tension_N(), solver.tension_N());
  return {motions_m.col(0), solver.length_m().col(0), solver.tension_N().col(0)};
}

void ExpectDerivative(const RobotCase& robot, ParameterPtr parameter, const Change& changed,
                      double step, double tolerance) {
  Balance balance = Solve(robot);
  for (size_t c = 0; c < robot.cables.size(); ++c) {
    const bool slack = balance.Tensions_N()[static_cast<Eigen::Index>(c)] == 0.0;
    ASSERT_EQ(slack, robot.cables[c].kind == ActuatorCommand::Kind::kDisplacement &&
                         robot.cables[c].value < 0.0)
        << "cable " << c;
  }
  const Derivative analytic = Differentiate(balance, robot, std::move(parameter));
  const Balance one_up = Solve(changed(step), &balance.state);
  const Balance one_down = Solve(changed(-step), &balance.state);
  const Balance two_up = Solve(changed(2.0 * step), &balance.state);
  const Balance two_down = Solve(changed(-2.0 * step), &balance.state);
  const auto difference = [&](const std::function<Eigen::VectorXd(const Balance&)>& value) {
    return Eigen::VectorXd(
        (8.0 * (value(one_up) - value(one_down)) - (value(two_up) - value(two_down))) /
        (12.0 * step));
  };
  const Eigen::VectorXd points = difference([](const Balance& b) { return b.Points_m(); });
  const Eigen::VectorXd lengths = difference([](const Balance& b) { return b.Lengths_m(); });
  const Eigen::VectorXd tensions = difference([](const Balance& b) { return b.Tensions_N(); });
  ASSERT_GT(points.norm(), 0.0);
  const double points_error = (analytic.points_m - points).norm() / points.norm();
  const double lengths_error =
      (analytic.lengths_m - lengths).norm() / NormOr(lengths, points.norm());
  // Where no tension follows, what is left of the differences is rounding.
  const double tensions_error =
      (analytic.tensions_N - tensions).norm() / NormOr(analytic.tensions_N, 1e-5 / step);
  EXPECT_LE(points_error, tolerance) << analytic.points_m.transpose() << "\n" << points.transpose();
  EXPECT_LE(lengths_error, tolerance) << analytic.lengths_m.transpose() << "\n"
                                      << lengths.transpose();
  EXPECT_LE(tensions_error, tolerance) << analytic.tensions_N.transpose() << "\n"
                                       << tensions.transpose();
}

}  // namespace palpate::robot
