// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <Eigen/Geometry>
#include <random>

#include "libs/fem/shape_functions.hpp"
#include "tests/libs/robot/sensitivity/robot_case.hpp"

namespace palpate::robot {
namespace {

class RestShapeOfRobot : public SensitivityCase {
 protected:
  /// A smooth field and a rough one on top, held nodes and mid-edge nodes included.
  Eigen::VectorXd Mode() const {
    std::mt19937 engine{11};
    const Eigen::Matrix3Xd& X = robot_.body.mesh.nodes_m;
    Eigen::VectorXd mode(X.size());
    for (Eigen::Index node = 0; node < X.cols(); ++node) {
      const double x = 10.0 * X(0, node);
      const Eigen::Vector3d smooth(0.3 * x * x, std::sin(2.0 * x), 0.5 + x * X(1, node) * 50.0);
      for (Eigen::Index i = 0; i < 3; ++i) {
        mode[3 * node + i] = smooth[i] + 0.1 * (static_cast<double>(engine()) / 4294967295.0 - 0.5);
      }
    }
    return mode;
  }

  Change Shaped(const Eigen::VectorXd& mode, CableZero zero, MassRule mass) const {
    return [=, this](double by) {
      RobotCase robot = robot_;
      robot.body.mesh.nodes_m.reshaped() += by * mode;
      for (size_t c = 0; c < 3; ++c) {
        ActuatorCommand& command = robot.cables[c];
        if (command.kind != ActuatorCommand::Kind::kDisplacement || zero != CableZero::kKept)
          continue;
        command.value += RestLength_m(robot.body, c) - RestLength_m(robot_.body, c);
      }
      const Eigen::VectorXd density_kg_m3 =
          Eigen::VectorXd::Constant(robot.body.mesh.CellCount(), 500.0);
      if (mass == MassRule::kNodalKept) return robot;
      const double total_kg = robot.body.node_mass_kg.sum();
      robot.body.node_mass_kg = fem::ConsistentNodalMass_kg(robot.body.mesh, density_kg_m3);
      if (mass == MassRule::kTotalKept) {
        robot.body.node_mass_kg *= total_kg / robot.body.node_mass_kg.sum();
      }
      return robot;
    };
  }
};

TEST_P(RestShapeOfRobot, Mode) {
  const Eigen::VectorXd mode = Mode();
  for (const auto& [zero, mass] : {std::pair{CableZero::kOfChangedShape, MassRule::kNodalKept},
                                   {CableZero::kKept, MassRule::kDensityKept},
                                   {CableZero::kKept, MassRule::kTotalKept}}) {
    ExpectDerivative(robot_, RestShapeMode(mode, zero, mass), Shaped(mode, zero, mass), 2e-5);
  }
}

TEST_P(RestShapeOfRobot, ModeOfACorotationalBodyAndOneOfSaintVenantAndKirchhoff) {
  for (fem::Material& material : robot_.body.materials) {
    material.volumetric = fem::Volumetric::kPointwise;
  }
  robot_.body.materials[0].model = fem::MaterialModel::kCorotational;
  robot_.body.materials[1].model = fem::MaterialModel::kStVenantKirchhoff;
  const Eigen::VectorXd mode = Mode();
  ExpectDerivative(robot_, RestShapeMode(mode, CableZero::kKept, MassRule::kNodalKept),
                   Shaped(mode, CableZero::kKept, MassRule::kNodalKept), 2e-5);
}

TEST_P(RestShapeOfRobot, Scale) {
  const Eigen::Vector3d centre_m(0.01, 0.004, 0.012);
  Eigen::VectorXd mode = robot_.body.mesh.nodes_m.reshaped();
  for (Eigen::Index node = 0; node < mode.size() / 3; ++node) {
    mode.segment<3>(3 * node) -= centre_m;
  }
  for (const auto& [zero, mass] : {std::pair{CableZero::kOfChangedShape, MassRule::kDensityKept},
                                   {CableZero::kKept, MassRule::kTotalKept}}) {
    ExpectDerivative(robot_, GeometryScale(centre_m, zero, mass), Shaped(mode, zero, mass), 2e-4);
  }
}

/// Undeformed shape, drives and gravity turned together turn everything.
TEST_P(RestShapeOfRobot, TurningEverythingTurnsTheBody) {
  robot_.loads.clear();
  const Eigen::Vector3d axis = Eigen::Vector3d(-0.5, 0.2, 0.9).normalized();
  Balance balance = Solve(robot_);
  Eigen::VectorXd mode = robot_.body.mesh.nodes_m.reshaped();
  for (Eigen::Index node = 0; node < mode.size() / 3; ++node) {
    mode.segment<3>(3 * node) = axis.cross(mode.segment<3>(3 * node).eval());
  }
  std::vector<ParameterPtr> parameters;
  parameters.push_back(RestShapeMode(mode, CableZero::kOfChangedShape, MassRule::kNodalKept));
  parameters.push_back(GravityTurn(axis));
  for (int c = 0; c < 3; ++c) {
    const Eigen::Vector3d along =
        axis.cross(robot_.body.cables[static_cast<size_t>(c)].pull_point_m);
    parameters.push_back(PullPointMove(c, along));
  }
  SensitivitySolver solver(*balance.model);
  ASSERT_TRUE(solver.Compute(robot_.cables, balance.state, parameters).ok());
  for (const BodyMarker& marker : robot_.body.markers) {
    const Eigen::Vector3d expected = axis.cross(marker.point.weights.Position(balance.state.x_m));
    const Eigen::Vector3d found = solver.PointMotion(marker.point.weights).rowwise().sum();
    EXPECT_LE((found - expected).norm(), 1e-9);
  }
  EXPECT_LE(solver.length_m().rowwise().sum().norm(), 1e-10);
  EXPECT_LE(solver.tension_N().rowwise().sum().norm(), 1e-8 * (1.0 + solver.tension_N().norm()));
}

INSTANTIATE_TEST_SUITE_P(SoftBeam, RestShapeOfRobot, AllCases());

}  // namespace
}  // namespace palpate::robot
